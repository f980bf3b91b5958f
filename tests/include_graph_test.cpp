// Tests the actual includes, whereas architecture_test tests the allowed ones: no file and no
// folder may include itself through others.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

using Graph = std::map<std::string, std::set<std::string>>;

// Returns, for each file of the product, the files that it includes, as paths from the top of the
// tree.
Graph filesGraph() {
  const fs::path root = MERLIN_SOURCE_DIR;
  Graph graph;
  for (const char* top : {"daemon", "drivers", "nn", "render", "config"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      auto& includes = graph[fs::relative(entry.path(), root).generic_string()];
      std::ifstream in(entry.path());
      constexpr std::string_view kDirective = "#include \"";
      for (std::string line; std::getline(in, line);) {
        if (!line.starts_with(kDirective)) continue;
        const std::size_t end = std::min(line.find('"', kDirective.size()), line.size());
        const std::string header = line.substr(kDirective.size(), end - kDirective.size());
        if (fs::exists(root / header)) includes.insert(header);
      }
    }
  }
  return graph;
}

// Returns, for each folder, the folders that it includes. Headers that contain only settings do not
// count, since config includes those of many folders.
Graph foldersGraph(const Graph& files) {
  const auto folderOf = [](const std::string& file) {
    return fs::path(file).parent_path().generic_string();
  };
  Graph folders;
  for (const auto& [file, includes] : files) {
    for (const std::string& header : includes) {
      if (folderOf(header) == folderOf(file) || header.ends_with("settings.h")) continue;
      folders[folderOf(file)].insert(folderOf(header));
    }
  }
  return folders;
}

// Returns a path from a node back to itself, "a > b > a"; empty if there is none.
std::string cycleIn(const Graph& graph) {
  std::set<std::string> done;
  std::vector<std::string> path;
  std::string found;
  const std::function<void(const std::string&)> visit = [&](const std::string& node) {
    const auto again = std::find(path.begin(), path.end(), node);
    if (again != path.end() && found.empty()) {
      for (auto at = again; at != path.end(); ++at) found += *at + " > ";
      found += node;
    }
    if (again != path.end() || !done.insert(node).second) return;
    path.push_back(node);
    if (const auto next = graph.find(node); next != graph.end()) {
      for (const std::string& to : next->second) visit(to);
    }
    path.pop_back();
  };
  for (const auto& [node, unused] : graph) visit(node);
  return found;
}

TEST(CycleIn, FindsAWayBack) {
  EXPECT_EQ(cycleIn({{"a", {"b", "c"}}, {"b", {"c"}}, {"d", {"a"}}}), "");
  EXPECT_EQ(cycleIn({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}}), "b > c > b");
}

TEST(IncludeGraph, NoFileIncludesItselfThroughOthers) {
  const Graph files = filesGraph();
  EXPECT_GT(files.size(), 400U);
  EXPECT_EQ(cycleIn(files), "");
}

TEST(IncludeGraph, NoFolderIncludesItselfThroughOthers) {
  const Graph folders = foldersGraph(filesGraph());
  EXPECT_GT(folders.size(), 50U);
  EXPECT_EQ(cycleIn(folders), "");
}

}  // namespace
