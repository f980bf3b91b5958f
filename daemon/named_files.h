// Files that the configuration names and whose contents take effect as its own settings do: a file
// that keeps its name may have changed.
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

// A change for each file that has the same name in both and other contents. The names are compared
// as settings are.
std::vector<SettingChange> changesBetween(const NamedFiles& before, const NamedFiles& after);

}  // namespace merlin
