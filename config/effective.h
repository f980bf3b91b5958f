// The settings in effect, one by one: value, default, and whether the two differ. For people and
// programs that compare configurations.
#pragma once

#include <string>
#include <vector>

#include "config/settings.h"
#include "config/writer.h"

namespace merlin {

struct SettingValue {
  std::string pointer;        // RFC 6901, "/wall/rate/rate_hz"
  std::string value;          // as JSON text on one line
  std::string default_value;  // likewise; empty: the setting exists because of others only
  bool operator==(const SettingValue&) const = default;
};

// Returns every setting, in the order of written files. A list of objects is represented by the
// settings of its entries, or by itself if it is empty. The default of an entry's setting is that
// of the default list's entry if both lists are equally long; otherwise that of a new entry.
std::vector<SettingValue> valuesOf(const Settings& settings, Secrets secrets = Secrets::kWritten);

struct SettingChange {
  std::string pointer;
  std::string before, after;  // as JSON text; empty: there is no such setting
  bool operator==(const SettingChange&) const = default;
};

// Returns the settings that differ, in the order of written files. Cost: O(settings log settings).
std::vector<SettingChange> changesBetween(const Settings& before, const Settings& after,
                                          Secrets secrets = Secrets::kWritten);

// Returns the settings that differ from the defaults.
std::vector<SettingChange> changesFromDefaults(const Settings& settings,
                                               Secrets secrets = Secrets::kWritten);

// Returns the names of files with secrets, as far as `settings` names such files.
std::vector<std::string> secretFilesOf(const Settings& settings);

}  // namespace merlin
