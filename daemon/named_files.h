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

// A file that a setting names. NamedFiles has an entry for each such setting, by its JSON pointer.
struct NamedFile {
  std::string name;
  std::size_t contents = 0;  // a hash of the bytes, or of why they cannot be read
  bool operator==(const NamedFile&) const = default;
};
using NamedFiles = std::map<std::string, NamedFile>;

// Reads the keys, lists of keys, postures and gestures that the settings name. O(size of the
// files).
NamedFiles readNamedFiles(const Settings& settings);

// Returns a change for each setting that names the same file in both, if the file's contents
// differ. A changed name is not reported, because comparing the settings finds it.
std::vector<SettingChange> changesBetween(const NamedFiles& before, const NamedFiles& after);

}  // namespace merlin
