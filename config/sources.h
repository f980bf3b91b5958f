// Reads and merges the files of a configuration: the file that merlind is given, and the files of
// the folder conf.d beside it, whose settings take precedence.
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

// Parses the text of a file, which must be a JSON object, and appends the file to loaded.sources.
// `file`: name of the file; empty for the configuration itself and for a text without a file. Line
// numbers in the tree continue those of the files before. If the text is invalid, adds a finding to
// `loaded` and returns nothing.
std::optional<JsonNode> parseSource(std::string_view text, const std::string& file,
                                    LoadedSettings& loaded);

// Reads the file at `path` and conf.d/*.json in its folder, in the order of their names, and merges
// each over those before: objects are merged by key; any other value, lists included, replaces the
// former one. Files whose names begin with a dot are not read. If any file has a fault, adds
// findings to `loaded` and returns nothing. Cost: O(files' bytes).
std::optional<JsonNode> readSources(const std::string& path, LoadedSettings& loaded);

// Merges `over` into `base`: objects by key; any other value of `over` replaces that of `base`.
// REQUIRES: both are objects.
void mergeOver(JsonNode& base, JsonNode over);

}  // namespace merlin
