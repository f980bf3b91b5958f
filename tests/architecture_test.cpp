// Tests the dependency rules of README.md, "Who may include whom", and a few rules about files.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;
using Folders = std::set<std::string>;

// For each folder: the folders that it may include besides itself and daemon/base. A new folder
// needs an entry here, and the entry needs a review. "a/settings.h" allows this header only.
const std::map<std::string, Folders> kMayInclude = {
    {"daemon/base", {}},
    {"daemon/json", {}},
    {"daemon/manual", {}},
    {"daemon/net", {}},
    {"daemon/shm", {"drivers/port"}},
    {"daemon/state", {"daemon/json"}},
    {"daemon/reload", {"config"}},
    {"daemon/alarms", {"daemon/json"}},
    {"daemon/actions", {"daemon/shm", "drivers/port"}},
    {"daemon/status", {"daemon/net", "daemon/shm", "drivers/port"}},
    {"daemon/serve", {"daemon/net", "daemon/shm", "drivers/port"}},
    {"daemon/rfb",
     {"daemon/cli/exit_status.h", "daemon/cli/parse_arguments.h", "daemon/cli/stop_signals.h",
      "daemon/net", "daemon/shm", "daemon/status", "render/out", "render/testcard/area.h",
      "render/testcard/font.h"}},
    {"daemon/import",
     {"daemon/cli/exit_status.h", "render/import", "render/mesh/io", "render/points",
      "render/points/io"}},
    {"daemon/page",
     {"daemon/json", "daemon/net", "daemon/rfb/shown_picture.h", "daemon/rfb/view.h", "daemon/shm",
      "daemon/status", "render/image", "render/testcard/card.h"}},
    {"daemon/devices",
     {"config", "daemon/actions", "daemon/shm", "drivers", "drivers/gpio", "drivers/hand",
      "drivers/pjlink", "drivers/port", "drivers/loop", "drivers/io", "nn", "nn/gesture", "nn/io"}},
    {"daemon/wall",
     {"config",
      "daemon/actions",
      "daemon/shm",
      "daemon/state",
      "drivers/hand",
      "drivers/port/health_reasons.h",
      "render/content",
      "render/content/picture",
      "render/correct",
      "render/correct/gpu",
      "render/correct/io",
      "render/frame",
      "render/gl",
      "render/governor",
      "render/image",
      "render/lod",
      "render/lod/io",
      "render/out",
      "render/panel",
      "render/room",
      "render/scene",
      "render/stereo",
      "render/testcard",
      "render/text",
      "render/tiles"}},
    {"daemon/cli", {"daemon/manual", "daemon/shm", "daemon/status", "drivers/port"}},
    {"daemon/cli/calibrate",
     {"config", "daemon/cli", "drivers", "drivers/cyberglove", "drivers/evdev", "drivers/fastrak",
      "drivers/hand", "drivers/io", "drivers/port", "drivers/spaceball", "drivers/vrpn"}},
    {"daemon/cli/devices",
     {"config", "daemon/cli", "daemon/shm", "drivers/evdev", "drivers/io", "drivers/port",
      "drivers/vrpn"}},
    {"daemon/cli/line", {"config", "daemon/cli", "drivers", "drivers/emulate", "drivers/io"}},
    {"daemon/cli/mesh",
     {"daemon/cli", "render/compare", "render/content", "render/frame", "render/image",
      "render/fuse", "render/inventor", "render/lod", "render/lod/io", "render/mesh",
      "render/mesh/io", "render/points", "render/points/io", "render/range", "render/range/io",
      "render/reduce", "render/scan", "render/segment"}},
    {"daemon/cli/image", {"daemon/cli", "render/image"}},
    {"daemon/cli/config",
     {"config", "daemon/cli", "daemon/cli/wall/reload.h", "daemon/json", "daemon/state"}},
    {"daemon/cli/report",
     {"config", "daemon/cli", "daemon/cli/wall", "daemon/shm", "daemon/state", "render/image",
      "render/out"}},
    {"daemon/cli/show",
     {"daemon/cli", "daemon/cli/image", "daemon/cli/mesh", "daemon/shm", "render/image",
      "render/lod/io", "render/range/io"}},
    {"daemon/cli/gesture", {"daemon/cli", "drivers/hand", "nn/gesture", "nn/io"}},
    {"daemon/cli/posture",
     {"daemon/cli", "daemon/shm", "drivers/cyberglove", "drivers/hand", "nn", "nn/io"}},
    {"daemon/cli/wall",
     {"config", "daemon/cli", "daemon/reload/plan.h", "daemon/shm", "daemon/state", "daemon/status",
      "render/correct/io", "render/gl/gpu_list.h", "render/image", "render/out", "render/room",
      "render/testcard/card.h", "render/tiles"}},
    {"daemon/cli/watch", {"daemon/cli", "daemon/cli/wall", "daemon/status"}},
    // The composition root, which may include every component.
    {"daemon",
     {"config", "daemon/actions", "daemon/alarms", "daemon/cli", "daemon/devices", "daemon/net",
      "daemon/page", "daemon/reload", "daemon/serve", "daemon/shm", "daemon/state", "daemon/status",
      "daemon/wall", "drivers/emulate/names.h", "render/gl", "render/image/overview.h"}},
    {"drivers/port", {}},
    {"drivers/cyberglove", {"drivers/port"}},
    {"drivers/fastrak", {"drivers/port"}},
    {"drivers/vrpn", {"drivers/port"}},
    {"drivers/spaceball", {"drivers/port"}},
    {"drivers/spacenav", {"drivers/port"}},
    {"drivers/evdev", {"drivers/port"}},
    {"drivers/touch", {"drivers/port"}},
    {"drivers/tuio", {"drivers/port"}},
    {"drivers/osc", {"drivers/port"}},
    {"drivers/sample", {"drivers/port"}},
    {"drivers/hand", {"drivers/port"}},
    {"drivers/gpio", {"drivers/port"}},
    // projector, protocol and schedule are pure.
    {"drivers/pjlink", {"drivers/port"}},
    {"drivers/io", {"drivers/port"}},
    {"drivers/loop", {"drivers/port"}},
    {"drivers/emulate",
     {"drivers/port", "drivers/hand", "drivers/cyberglove", "drivers/fastrak",
      "drivers/spaceball"}},
    // The registry is the only folder that names every driver.
    {"drivers",
     {"drivers/port", "drivers/cyberglove", "drivers/evdev", "drivers/fastrak", "drivers/osc",
      "drivers/spaceball", "drivers/spacenav", "drivers/sample", "drivers/touch", "drivers/tuio",
      "drivers/vrpn"}},
    {"nn", {}},
    {"nn/gesture", {}},
    {"nn/io", {"daemon/json", "nn", "nn/gesture"}},
    {"render/image", {}},
    {"render/mesh", {}},
    // Pure.
    {"render/mesh/atlas", {"render/image", "render/mesh"}},
    {"render/mesh/io", {"render/image", "render/mesh", "render/mesh/atlas"}},
    // Pure except for its threads; its results do not depend on the number of threads.
    {"render/range", {"render/mesh"}},
    {"render/range/io",
     {"render/image", "render/mesh", "render/mesh/io", "render/mesh/io/ply", "render/range"}},
    {"render/points", {"render/mesh"}},
    {"render/points/io", {"render/mesh/io/ply", "render/points", "render/range/io"}},
    {"render/lod", {"render/mesh"}},
    {"render/lod/io", {"render/lod"}},
    {"render/reduce", {"render/lod", "render/mesh"}},
    {"render/inventor", {"render/lod", "render/mesh/io"}},
    {"render/segment", {"render/mesh", "render/reduce"}},
    // Pure except for its threads; its results do not depend on the number of threads.
    {"render/compare", {"render/lod", "render/mesh"}},
    // Pure except for its threads; its results do not depend on the number of threads.
    {"render/scan", {"render/compare", "render/image", "render/mesh", "render/range"}},
    // Pure except for its threads; its results do not depend on the number of threads.
    {"render/fuse", {"render/mesh", "render/range"}},
    {"render/governor", {}},
    {"render/tiles", {}},
    {"render/room", {"render/tiles"}},
    {"render/scene", {"drivers/port", "render/content/navigation.h"}},
    {"render/gl", {}},
    {"render/content", {"render/gl", "render/image", "render/lod"}},
    {"render/content/picture", {"render/content", "render/gl", "render/image"}},
    {"render/content/sample", {"render/content", "render/gl"}},
    // The folder has the program merlin-import, which merlind neither links nor starts.
    {"render/import",
     {"render/image", "render/mesh", "render/mesh/atlas", "render/mesh/io", "render/points",
      "render/range", "render/range/io"}},
    {"render/frame",
     {"render/content", "render/gl", "render/image", "render/lod", "render/out",
      "render/stereo/anaglyph.h", "render/tiles"}},
    {"render/stereo", {"drivers/port", "render/out/settings.h", "render/tiles"}},
    {"render/out",
     {"daemon/shm/seq_slot.h", "render/correct/settings.h", "render/image", "render/out/kms",
      "render/out/picture", "render/out/window", "render/tiles"}},
    // The folder has the program merlin-window, which includes nothing else of MERLIN.
    {"render/out/window", {}},
    // choice, buffer_turns and settings are pure.
    {"render/out/kms", {"render/out/picture"}},
    // Pure.
    {"render/out/picture", {}},
    // Pure, except for the threads to which the rows are distributed. Of render/frame it includes
    // only the port.
    {"render/correct", {"render/frame/correction.h"}},
    {"render/correct/gpu", {"render/correct", "render/gl"}},
    {"render/correct/io", {"render/correct", "render/image"}},
    {"render/out/sample", {"render/out"}},
    {"render/testcard", {"render/frame", "render/out/settings.h", "render/tiles"}},
    {"render/text", {"render/frame/overlay.h", "render/tiles"}},
    {"render/panel", {"render/frame/overlay.h", "render/text", "render/tiles"}},
    {"config",
     {"daemon/json",
      "daemon/manual/roff.h",
      "daemon/actions/input.h",
      "daemon/actions/settings.h",
      "daemon/alarms/settings.h",
      "daemon/page/settings.h",
      "daemon/serve/settings.h",
      "daemon/wall/settings.h",
      "drivers",
      "drivers/port",
      "drivers/gpio/settings.h",
      "drivers/hand/settings.h",
      "drivers/pjlink/settings.h",
      "nn/settings.h",
      "render/frame/settings.h",
      "render/governor/settings.h",
      "render/out/room_blend.h",
      "render/out/settings.h",
      "render/room",
      "render/scene/settings.h",
      "render/stereo",
      "render/text/settings.h",
      "render/tiles/settings.h"}},
};

// For each third-party header: the only folders that may include it.
const std::map<std::string, Folders> kOnlyIn = {
    {"libserialport.h", {"drivers/io"}},
    {"libevdev/libevdev.h", {"drivers/io"}},
    {"gpiod.h", {"drivers/io"}},
    {"oscpack/osc/OscReceivedElements.h", {"drivers/port"}},
    {"zmq.hpp", {"daemon/status"}},
    {"zmq.h", {"daemon/status"}},
    {"nlohmann/json.hpp",
     {"config",
      "nn/io",
      "daemon/json",
      "daemon/reload",
      "daemon/state",
      "daemon/status",
      "daemon/cli",
      "daemon/page",
      "daemon/cli/mesh",
      "daemon/cli/posture",
      "daemon/cli/wall",
      "daemon/cli/calibrate",
      "daemon/cli/config",
      "daemon/cli/devices",
      "daemon/cli/gesture",
      "daemon/cli/image",
      "daemon/cli/line",
      "daemon/cli/report",
      "daemon/cli/show",
      "daemon/cli/watch",
      "render/import",
      "render/mesh/io/gltf"}},
    {"microhttpd.h", {"daemon/page"}},
    {"qrencode.h", {"daemon/page"}},
    {"EGL/egl.h", {"render/gl"}},
    {"EGL/eglext.h", {"render/gl"}},
    {"GL/osmesa.h", {"render/gl"}},
    {"GL/glcorearb.h", {"render/gl"}},
    {"SDL.h", {"render/out/window"}},
    {"xf86drm.h", {"render/out/kms"}},
    {"xf86drmMode.h", {"render/out/kms"}},
    {"drm_fourcc.h", {"render/out/kms"}},
    {"ft2build.h", {"render/text"}},
    {"png.h", {"render/image"}},
    {"turbojpeg.h", {"render/image"}},
    {"zlib.h", {"render/image", "render/mesh/io"}},
    {"nettle/md5.h", {"drivers/pjlink"}},
    {"fitsio.h", {"render/import"}},
    {"gdal.h", {"render/import"}},
    {"vips/vips.h", {"render/import"}},
    {"archive.h", {"daemon/cli/report"}},
    {"curses.h", {"daemon/cli/watch"}},
    {"archive_entry.h", {"daemon/cli/report"}},
    {"zip.h", {"render/correct/io", "render/import"}},
    {"pugixml.hpp", {"render/correct/io"}},
    {"xxhash.h", {"render/lod/io"}},
    {"rfb/rfb.h", {"daemon/rfb"}},
    {"rfb/rfbregion.h", {"daemon/rfb"}},
    {"CLI/CLI.hpp", {"daemon", "daemon/cli", "daemon/rfb"}},
    {"systemd/sd-daemon.h", {"daemon"}},
    {"spdlog/spdlog.h", {"daemon/base"}},
};

// Pure folders may not include the headers in kImpure: they have no clock, no file and no thread of
// their own.
const Folders kPure = {"nn",
                       "nn/gesture",
                       "drivers/port",
                       "drivers/cyberglove",
                       "drivers/fastrak",
                       "drivers/spaceball",
                       "drivers/spacenav",
                       "drivers/evdev",
                       "drivers/touch",
                       "drivers/tuio",
                       "drivers/osc",
                       "drivers/sample",
                       "drivers/hand",
                       "drivers/emulate",
                       "render/mesh",
                       "render/points",
                       "render/range",
                       "render/lod",
                       "render/reduce",
                       "render/segment",
                       "render/compare",
                       "render/scan",
                       "render/fuse",
                       "render/governor",
                       "render/tiles",
                       "render/room",
                       "render/scene",
                       "render/stereo"};
const Folders kImpure = {"fstream",
                         "thread",
                         "mutex",
                         "filesystem",
                         "random",
                         "fcntl.h",
                         "unistd.h",
                         "ctime",
                         "chrono",
                         "iostream",
                         "sstream",
                         "cstdio",
                         "daemon/base/files.h",
                         "daemon/base/log.h",
                         "daemon/base/shared_memory.h"};

// Folders with private subfolders. Only the folder itself, and folders whose row above names one of
// the subfolders, may include them. The set is what each subfolder may include. A new subfolder
// needs no entry.
const std::map<std::string, Folders> kPrivateTo = {
    // Pure.
    {"render/mesh/atlas", {"render/image", "render/mesh"}},
    {"render/mesh/io", {"render/image", "render/mesh", "render/mesh/atlas"}},
    {"render/reduce", {"render/lod", "render/mesh", "render/reduce/quadric"}},
};

// Returns the parent folder if the folder is private to it; empty if the folder is not private.
std::string ownerOf(const std::string& folder) {
  const std::string above = fs::path(folder).parent_path().generic_string();
  return kPrivateTo.count(above) ? above : "";
}

// Returns the folders that `folder` may include; null if there are no rules for `folder`.
const Folders* rulesOf(const std::string& folder) {
  if (const std::string owner = ownerOf(folder); !owner.empty()) return &kPrivateTo.at(owner);
  const auto found = kMayInclude.find(folder);
  return found == kMayInclude.end() ? nullptr : &found->second;
}

bool mayInclude(const std::string& from, const std::string& to, const std::string& header) {
  if (to == from || to == "daemon/base") return true;
  const std::string owner = ownerOf(to);
  if (!owner.empty())
    return from == owner || (ownerOf(from) == owner && kPrivateTo.at(owner).count(to) > 0) ||
           rulesOf(from)->count(to) > 0;
  if (to == ownerOf(from)) return true;
  const Folders& allowed = *rulesOf(from);
  return allowed.count(to) > 0 || allowed.count(header) > 0;
}

std::string folderOf(const fs::path& header) { return header.parent_path().generic_string(); }

// Returns the header "a/b.h" of `#include "a/b.h"` or `#include <a/b.h>`; empty for any other line.
std::string included(const std::string& line) {
  constexpr std::string_view kDirective = "#include ";
  if (!line.starts_with(kDirective)) return {};
  const std::size_t end = line.find_first_of("\">", kDirective.size() + 1);
  return end == std::string::npos ? ""
                                  : line.substr(kDirective.size() + 1, end - kDirective.size() - 1);
}

void checkInclude(const fs::path& root, const std::string& from, const std::string& header,
                  const std::string& where) {
  if (const auto only = kOnlyIn.find(header); only != kOnlyIn.end()) {
    EXPECT_TRUE(only->second.count(from)) << where;
  }
  EXPECT_TRUE(from == "render/mesh/io/openmesh" || !header.starts_with("OpenMesh/")) << where;
  EXPECT_TRUE(from == "render/inventor" || from == "render/import" ||
              !header.starts_with("Inventor/"))
      << where << ": Coin";
  EXPECT_TRUE(from == "render/import" || !header.starts_with("assimp/")) << where;
  EXPECT_TRUE(from == "render/import" || !header.starts_with("open3d/")) << where;
  EXPECT_FALSE((kPure.count(from) || kPure.count(ownerOf(from))) && kImpure.count(header)) << where;
  if (!fs::exists(root / header)) return;  // a header of the standard library or of a third party
  const std::string to = folderOf(header);
  EXPECT_TRUE(mayInclude(from, to, header)) << where;
}

TEST(Architecture, EveryIncludeFollowsTheRules) {
  const fs::path root = MERLIN_SOURCE_DIR;
  int files = 0;
  for (const char* top : {"daemon", "drivers", "nn", "render", "config"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      ++files;
      const std::string from = folderOf(fs::relative(entry.path(), root));
      ASSERT_TRUE(rulesOf(from)) << from << " has no line in kMayInclude";
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);) {
        const std::string header = included(line);
        if (!header.empty()) checkInclude(root, from, header, entry.path().string() + ": " + line);
      }
    }
  }
  EXPECT_GT(files, 100);
}

// Returns whether the file names the driver: its folder, its name in the registry, or its word in
// CMake's list.
bool namesDriver(const fs::path& file, const std::string& driver) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const bool listed =
        line.starts_with("set(MERLIN_DRIVERS ") &&
        (line.ends_with(' ' + driver + ')') || line.find(' ' + driver + ' ') != std::string::npos);
    if (listed || line.find("drivers/" + driver + '/') != std::string::npos ||
        line.find("{\"" + driver + "\", SampleKind::") != std::string::npos ||
        line.find("merlin::" + driver + ' ') != std::string::npos)
      return true;
  }
  return false;
}

// Tests what drivers/README.md says about a new driver of a known kind. `sample` has no settings of
// its own, `spacenav` has some; no other file may name these drivers.
TEST(Architecture, ADriverOfAKnownKindIsNamedInTwoFilesAndWithSettingsInThree) {
  const fs::path root = MERLIN_SOURCE_DIR;
  const auto namedIn = [&](const std::string& driver) {
    std::set<std::string> files;
    for (const char* top : {"daemon", "drivers", "nn", "render", "config"}) {
      for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
        const std::string file = fs::relative(entry.path(), root).generic_string();
        const auto extension = entry.path().extension();
        const bool is_code = extension == ".h" || extension == ".cpp" || extension == ".txt";
        if (is_code && !file.starts_with("drivers/" + driver + '/') &&
            namesDriver(entry.path(), driver))
          files.insert(file);
      }
    }
    return files;
  };
  EXPECT_EQ(namedIn("sample"),
            (std::set<std::string>{"drivers/CMakeLists.txt", "drivers/registry.cpp"}));
  EXPECT_EQ(namedIn("spacenav"),
            (std::set<std::string>{"drivers/CMakeLists.txt", "drivers/registry.cpp",
                                   "drivers/registry.h"}));
}

// Returns whether a file of `folder`, or of a folder that is private to it, includes what the rule
// names.
bool isUsed(const fs::path& root, const std::string& folder, const std::string& rule) {
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    const auto extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    const std::string from = folderOf(fs::relative(entry.path(), root));
    if (from != folder && ownerOf(from) != folder) continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      const std::string header = included(line);
      if (header == rule || folderOf(header) == rule) return true;
    }
  }
  return false;
}

TEST(Architecture, EveryRuleIsUsed) {
  const fs::path root = MERLIN_SOURCE_DIR;
  for (const auto& [folder, rules] : kMayInclude) {
    for (const std::string& rule : rules) {
      EXPECT_TRUE(isUsed(root, folder, rule))
          << "no file in " << folder << " includes " << rule << ": remove it from kMayInclude";
    }
  }
}

TEST(Architecture, EveryFolderSaysWhatItIsFor) {
  const fs::path root = MERLIN_SOURCE_DIR;
  for (const auto& [folder, unused] : kMayInclude) {
    const fs::path readme = root / folder / "README.md";
    ASSERT_TRUE(fs::exists(readme)) << readme;
    EXPECT_GT(fs::file_size(readme), 100U) << readme;
  }
}

TEST(Architecture, EveryPrivateFolderSaysWhatItIsFor) {
  const fs::path root = MERLIN_SOURCE_DIR;
  for (const auto& [owner, unused] : kPrivateTo) {
    for (const auto& entry : fs::directory_iterator(root / owner)) {
      if (!entry.is_directory()) continue;
      EXPECT_TRUE(fs::exists(entry.path() / "README.md")) << entry.path();
    }
  }
}

// Expects that allowed includes lead from `folder` to no folder from which `start` can be reached;
// `seen` holds the folders visited so far.
void expectNoWayBack(const std::string& start, const std::string& folder, Folders& seen) {
  for (const std::string& rule : *rulesOf(folder)) {
    const std::string to = rule.ends_with(".h") ? folderOf(rule) : rule;
    if (rule.ends_with("settings.h")) continue;  // plain structs that include no other folder
    EXPECT_NE(to, start) << "a cycle through " << folder;
    if (to != start && seen.insert(to).second) expectNoWayBack(start, to, seen);
  }
}

TEST(Architecture, NoFolderIncludesItselfThroughOthers) {
  for (const auto& [folder, unused] : kMayInclude) {
    Folders seen;
    expectNoWayBack(folder, folder, seen);
  }
}

TEST(Architecture, TheTopLevelIsFixed) {
  const Folders kAllowed = {
      "CMakeLists.txt",    "daemon", "drivers",   "nn",      "render",          "config",
      "systemd",           "tests",  "README.md", "LICENSE", "CONTRIBUTING.md", "CHANGELOG.md",
      "CMakePresets.json", "dev",    "build"};
  for (const auto& entry : fs::directory_iterator(MERLIN_SOURCE_DIR)) {
    const std::string name = entry.path().filename();
    EXPECT_TRUE(name.starts_with(".") || kAllowed.count(name)) << name;
  }
}

std::string textOf(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Architecture, AFileOfRenderIsInTheNamespaceOfItsFolder) {
  const fs::path render = fs::path(MERLIN_SOURCE_DIR) / "render";
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(render)) {
    const auto extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    // Node classes of Coin are in the global namespace, as Coin's own are.
    if (entry.path().filename().string().starts_with("so_")) continue;
    ++files;
    const std::string folder = fs::relative(entry.path(), render).begin()->string();
    const std::string text = textOf(entry.path());
    const std::string wanted = "\nnamespace merlin::render::" + folder;
    EXPECT_TRUE(text.find(wanted + " {") != std::string::npos ||
                text.find(wanted + "::") != std::string::npos)
        << entry.path();
    EXPECT_EQ(text.find("\nnamespace merlin::render {"), std::string::npos) << entry.path();
  }
  EXPECT_GT(files, 100);
}

TEST(Architecture, AFileStartsWithWhatItIsFor) {
  const fs::path root = MERLIN_SOURCE_DIR;
  for (const char* top : {"daemon", "drivers", "nn", "render", "config"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (entry.path().extension() != ".h") continue;
      std::ifstream in(entry.path());
      std::string first;
      std::getline(in, first);
      EXPECT_TRUE(first.starts_with("// ")) << entry.path();
    }
  }
}

}  // namespace
