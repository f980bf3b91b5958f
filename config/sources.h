// The files of a configuration: the one that merlind is given, and those of the folder conf.d
// beside it, which are merged over it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "config/loader.h"
#include "daemon/json/json_tree.h"

namespace merlin {

// Maximum number of files in conf.d. All files of a configuration together may have at most
// kMostJsonBytes, like a single one.
inline constexpr std::size_t kMostConfDFiles = 64;

// Parses the text of a file, which must be a JSON object; `file` is its name, empty for a text
// without one. Line numbers in the tree continue those of the files before. An error becomes a
// finding of `loaded`; then nothing is returned.
std::optional<JsonNode> parseSource(std::string_view text, const std::string& file,
                                    LoadedSettings& loaded);

// Reads the file at `path` and conf.d/*.json in its folder, in the order of their names, and merges
// each over those before: objects by key, everything else replaces what was there. Files whose
// names begin with a dot are not read. Faults of all files become findings of `loaded`; then
// nothing is returned. Cost: O(files' bytes).
std::optional<JsonNode> readSources(const std::string& path, LoadedSettings& loaded);

// Merges `over` into `base`, both objects.
void mergeOver(JsonNode& base, JsonNode over);

}  // namespace merlin
