// The files of a configuration: the one that merlind is given, and those of the folder conf.d
// beside it, which are merged over it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "config/loader.h"
#include "daemon/json/json_tree.h"

namespace merlin {

// Of conf.d. All files of a configuration together have at most kMostJsonBytes, as one alone.
inline constexpr std::size_t kMostConfDFiles = 64;

// Parses the text of a file that is to be an object; `file` is its name, empty for a text without
// one. The lines of the tree follow those of the files before. After an error, which becomes a
// finding of `loaded`, nothing.
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
