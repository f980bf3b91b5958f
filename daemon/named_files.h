// Files that the configuration names and whose contents take effect like its own settings. They are
// compared by content, since a file may change and keep its name.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "config/effective.h"
#include "config/settings.h"

namespace merlin {

// By JSON pointer of the setting that names the file.
struct NamedFile {
  std::string name;
  std::size_t contents = 0;  // a hash of the bytes, or of why they cannot be read
  bool operator==(const NamedFile&) const = default;
};
using NamedFiles = std::map<std::string, NamedFile>;

// Reads the keys, lists of keys, postures and gestures that the settings name. O(size of the
// files).
NamedFiles readNamedFiles(const Settings& settings);

// Returns a change for each file that has the same name but different contents in the two. Changed
// names are found by comparing the settings.
std::vector<SettingChange> changesBetween(const NamedFiles& before, const NamedFiles& after);

}  // namespace merlin
