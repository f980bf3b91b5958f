#include "config/sources.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/files.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

void moveLines(JsonNode& node, int by) {
  node.line += by;
  for (JsonNode& item : node.items) moveLines(item, by);
  for (JsonNode::Member& member : node.members) {
    member.line += by;
    moveLines(member.value, by);
  }
}

// Adds a finding about a file as a whole, such as that it cannot be read.
void addFault(const std::string& file, const Error& error, LoadedSettings& loaded) {
  std::string what = error.what;
  if (what.starts_with(file + ": ")) what = what.substr(file.size() + 2);
  Finding finding{false, 0, "", std::move(what)};
  if (!loaded.sources.empty()) finding.file = file;
  loaded.add(std::move(finding));
}

// Returns the paths of the files conf.d/*.json beside the configuration `path`, sorted; adds a
// finding if the folder cannot be read or has too many files.
std::vector<std::string> confDFiles(const std::string& path, LoadedSettings& loaded) {
  const fs::path folder = fs::path(path).parent_path() / "conf.d";
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.ends_with(".json") && name[0] != '.') files.push_back(entry->path().string());
  }
  if (error && error != std::errc::no_such_file_or_directory)
    addFault(folder.string(), {Errc::kIo, error.message()}, loaded);
  if (files.size() > kMostConfDFiles) {
    addFault(folder.string(),
             {Errc::kUnsupported, fmt::format("has {} files whose names end in .json; at most {} "
                                              "are allowed",
                                              files.size(), kMostConfDFiles)},
             loaded);
    files.clear();
  }
  std::sort(files.begin(), files.end());
  return files;
}

int linesIn(std::string_view text) {
  return 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

std::optional<JsonNode> parseSource(std::string_view text, const std::string& file,
                                    LoadedSettings& loaded) {
  const int before = loaded.sources.empty() ? 0 : loaded.sources.back().last_line;
  loaded.sources.push_back({file, before, before + linesIn(text)});
  auto tree = parseJson(text);
  if (!tree) {
    std::string what = tree.error().what;  // has the form "line N: ..."
    int line = 0;
    if (const auto colon = what.find(": "); colon != std::string::npos) {
      line = std::atoi(what.c_str() + 5);
      what = what.substr(colon + 2);
    }
    loaded.add({false, before + line, "", what, true});
    return std::nullopt;
  }
  JsonNode root = *std::move(tree);
  moveLines(root, before);
  if (root.kind == JsonNode::Kind::kObject) return root;
  loaded.add(
      {false, root.line, "", fmt::format("is {}; allowed is an object", describe(root)), true});
  return std::nullopt;
}

void mergeOver(JsonNode& base, JsonNode over) {
  std::unordered_map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < base.members.size(); ++i) places.emplace(base.members[i].key, i);
  for (JsonNode::Member& member : over.members) {
    const auto [place, fresh] = places.emplace(member.key, base.members.size());
    if (fresh) {
      base.members.push_back(std::move(member));
      continue;
    }
    JsonNode::Member& old = base.members[place->second];
    const auto kObject = JsonNode::Kind::kObject;
    if (old.value.kind == kObject && member.value.kind == kObject)
      mergeOver(old.value, std::move(member.value));
    else
      old = std::move(member);
  }
}

std::optional<JsonNode> readSources(const std::string& path, LoadedSettings& loaded) {
  const auto main = FileCopy::read(path, kMostJsonBytes + 1);
  if (!main) {
    addFault(path, main.error(), loaded);
    return std::nullopt;
  }
  auto root = parseSource(main->text(), "", loaded);
  std::size_t bytes = main->text().size();
  for (const std::string& file : confDFiles(path, loaded)) {
    const auto text = FileCopy::read(file, kMostJsonBytes + 1);
    if (!text) {
      addFault(file, text.error(), loaded);
      continue;
    }
    bytes += text->text().size();
    if (bytes > kMostJsonBytes) {
      addFault(file,
               {Errc::kUnsupported, fmt::format("with the files before it there are {} bytes; a "
                                                "configuration has at most {}",
                                                bytes, kMostJsonBytes)},
               loaded);
      break;
    }
    auto over = parseSource(text->text(), file, loaded);
    if (over && root) mergeOver(*root, *std::move(over));
  }
  if (!loaded.findings.empty()) return std::nullopt;
  return root;
}

}  // namespace merlin
