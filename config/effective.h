// Lists the settings in effect, each with its value and its default, and the differences between
// two configurations.
#pragma once

#include <string>
#include <vector>

#include "config/settings.h"
#include "config/writer.h"

namespace merlin {

struct SettingValue {
  std::string pointer;  // RFC 6901, "/wall/rate/rate_hz"
  std::string value;    // as JSON text on one line
  // The default value, as JSON text on one line. Empty: the setting has no default, because it
  // exists only as a consequence of other settings.
  std::string default_value;
  bool operator==(const SettingValue&) const = default;
};

// Returns every setting, in the order in which settingsText() writes them. A list of objects is
// represented by the settings of its entries, or by itself if it is empty. If a list is as long as
// the default list, the default of an entry's setting is the value in the default list; otherwise
// it is the value in a new entry.
std::vector<SettingValue> valuesOf(const Settings& settings, Secrets secrets = Secrets::kWritten);

struct SettingChange {
  std::string pointer;
  std::string before, after;  // as JSON text; empty: this configuration lacks the setting
  bool operator==(const SettingChange&) const = default;
};

// Returns the settings that differ: first those of `after`, in the order in which settingsText()
// writes them, then those that only `before` has. Cost: O(settings log settings).
std::vector<SettingChange> changesBetween(const Settings& before, const Settings& after,
                                          Secrets secrets = Secrets::kWritten);

// Returns the settings that differ from the defaults, in the order of changesBetween().
std::vector<SettingChange> changesFromDefaults(const Settings& settings,
                                               Secrets secrets = Secrets::kWritten);

// Returns the names of all files with secrets (keys, tokens, passwords) that `settings` names.
std::vector<std::string> secretFilesOf(const Settings& settings);

}  // namespace merlin
