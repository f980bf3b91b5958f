#include "daemon/wall/wall_checks.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "config/drawn_wall.h"
#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "render/correct/io/mpcdi.h"
#include "render/gl/gl_context.h"
#include "render/out/output_kinds.h"

namespace merlin::wall {
namespace {

constexpr const char* kCannot = "cannot be used: ";

// Returns the JSON pointer of the content; `entry.pointer` is that of the content's file.
std::string placeOf(const ContentEntry& entry) {
  if (!entry.pointer.starts_with("/wall/contents/")) return entry.pointer;
  return entry.pointer.substr(0, entry.pointer.rfind('/'));
}

// Whether the configuration gives content `i` of contentsOf() a name; otherwise the name is that of
// its file. `count`: number of contents.
bool isNamed(const WallSettings& wall, std::size_t i, std::size_t count) {
  const std::size_t before = count - wall.contents.size();  // 1 if /wall/model is a content, else 0
  return i >= before && !wall.contents[i - before].name.empty();
}

// Returns a text about the consequence of a content that cannot be read. `any`: whether any other
// content can be read. `is_start`: whether merlind starts now.
const char* consequence(bool any, bool is_start) {
  if (is_start) {
    return any ? "; the wall is shown without it until it can be read"
               : "; the wall is shown without any content until one can be read";
  }
  return any ? "; a reload refuses it, a start shows the wall without it until it can be read"
             : "; a reload refuses it, a start shows the wall without any content until one can be "
               "read";
}

// Reads each content and adds the findings. Returns all contents if `keep`, which means that
// merlind starts now; otherwise only those that cannot be read.
std::vector<WallContent> readEach(LoadedSettings& loaded, bool keep) {
  std::vector<WallContent> contents;
  bool any = false;
  for (const ContentEntry& entry : contentsOf(loaded.settings.wall)) {
    if (entry.path.empty()) {
      loaded.addFinding(entry.pointer,
                        "names no .mrm file (make one with: merlin mesh reduce IN -o OUT.mrm)");
      continue;
    }
    const auto stamp = fileOrFolderStamp(entry.path);
    std::vector<std::string> skipped;
    auto content = readContent(entry, loaded.settings.wall.render.model.show, {}, skipped);
    if (content) {
      if (keep) contents.push_back(*std::move(content));
      any = true;
    } else if (content.error().code == Errc::kInvalidArgument) {
      loaded.addFinding("/wall/render/show", kCannot + content.error().what);
    } else {
      contents.push_back(missingContent(entry, content.error().what, stamp));
    }
  }
  for (const WallContent& content : contents) {
    if (content.fault.empty()) continue;
    loaded.add({keep || any, loaded.lineOf(content.entry.pointer), content.entry.pointer,
                kCannot + content.fault + consequence(any, keep)});
  }
  return contents;
}

}  // namespace

std::vector<WallContent> readContents(LoadedSettings& loaded) { return readEach(loaded, true); }

void checkContents(LoadedSettings& loaded) { (void)readEach(loaded, false); }

void checkNames(LoadedSettings& loaded) {
  const WallSettings& wall = loaded.settings.wall;
  const std::vector<ContentEntry> contents = contentsOf(wall);
  const std::size_t count = contents.size();
  for (std::size_t i = 0; i < count; ++i) {
    const ContentEntry& entry = contents[i];
    const auto same = std::ranges::find(contents, entry.name, &ContentEntry::name);
    const auto first = static_cast<std::size_t>(same - contents.begin());
    if (first == i || entry.path.empty()) continue;
    if (isNamed(wall, first, count) && isNamed(wall, i, count)) continue;
    loaded.addFinding(placeOf(entry),
                      fmt::format("has the name \"{}\", as {} has; give one of them another name",
                                  excerpt(entry.name), placeOf(*same)));
  }
}

void checkPlaylist(LoadedSettings& loaded) {
  checkNames(loaded);
  const std::vector<std::string>& names = loaded.settings.wall.playlist.contents;
  const std::vector<ContentEntry> known = contentsOf(loaded.settings.wall);
  for (auto name = names.begin(); name != names.end(); ++name) {
    const std::string at = fmt::format("/wall/playlist/contents/{}", name - names.begin());
    if (std::ranges::find(known, *name, &ContentEntry::name) == known.end()) {
      loaded.addFinding(at, fmt::format("is \"{}\", which is not the name of a content; contents "
                                        "are {}",
                                        excerpt(*name), namesOf(known)));
    } else if (std::find(names.begin(), name, *name) != name) {
      loaded.addFinding(at, fmt::format("is \"{}\", which is already in the list", *name));
    }
  }
}

namespace {

// Adds a finding if `path`, to which an output writes PNG images, is an existing file of another
// kind.
void checkIsPicture(LoadedSettings& loaded, const std::string& path, const std::string& at) {
  std::ifstream there(path, std::ios::binary);
  char signature[8] = {};
  there.read(signature, sizeof signature);
  if (there.gcount() > 0 && std::string_view(signature, sizeof signature) != "\x89PNG\r\n\x1a\n") {
    loaded.addFinding(
        at, path + ": exists and is not a PNG file; name another file, or remove this one");
  }
}

// Adds an adjustment if the measured region is also used by an earlier output or has another size
// than this output. The region is used nevertheless, since only a person can see whether it fits.
void checkFits(LoadedSettings& loaded, const render::correct::MeasuredCorrection& measured,
               std::size_t index, const std::string& at) {
  const std::vector<render::out::OutputSettings>& outputs = loaded.settings.wall.outputs;
  const render::correct::CorrectionSettings& correction = outputs[index].correction;
  const auto same = std::ranges::find_if(outputs, [&](const render::out::OutputSettings& other) {
    return other.correction.mpcdi == correction.mpcdi &&
           other.correction.mpcdi_region == correction.mpcdi_region;
  });
  if (const auto first = static_cast<std::size_t>(same - outputs.begin()); first != index) {
    loaded.add({true, loaded.lineOf(at), at,
                fmt::format("is the region that the output {} uses too; each projector usually "
                            "needs a region of its own",
                            same->shownName())});
  }
  // drawnWall() needs valid settings.
  if (loaded.verdict() == LoadedSettings::Verdict::kInvalid) return;
  const WallSettings drawn = drawnWall(loaded.settings.wall);
  if (drawn.outputs.size() != outputs.size()) return;
  const auto size = render::out::pictureSize(drawn.outputs[index], drawn.tiles);
  if (!size || (size->width == measured.width && size->height == measured.height)) return;
  loaded.add({true, loaded.lineOf(at), at,
              fmt::format("was measured for {} x {} pixels and the output has {} x {}: its warp "
                          "and blend are stretched to that",
                          measured.width, measured.height, size->width, size->height)});
}

// Checks the MPCDI file of an output. At a start, a damaged file or one without the region is only
// an adjustment, because one output that looks wrong is better than a dark wall.
void checkMeasured(LoadedSettings& loaded, std::size_t index, bool is_start) {
  const render::correct::CorrectionSettings correction =
      loaded.settings.wall.outputs[index].correction;
  if (correction.mpcdi.empty()) return;
  const std::string at = fmt::format("/wall/outputs/{}/correction", index);
  const auto measured = render::correct::readMeasured(correction.mpcdi, correction.mpcdi_region);
  if (measured) return checkFits(loaded, *measured, index, at + "/mpcdi");
  const bool no_region = measured.error().code == Errc::kInvalidArgument;
  const std::string where = at + (no_region ? "/mpcdi_region" : "/mpcdi");
  const std::string what = kCannot + measured.error().what;
  if (!is_start) return loaded.addFinding(where, what);
  loaded.add({true, loaded.lineOf(where), where,
              what + "; the output is shown without its measured warp and blend"});
}

}  // namespace

void checkReplacesNothing(LoadedSettings& loaded, const std::string& path, const std::string& at) {
  const Settings& s = loaded.settings;
  std::vector<std::string> read = {s.devices.postures,       s.devices.gestures,
                                   s.serve.samples_keys,     s.serve.samples_clients,
                                   s.serve.commands_keys,    s.serve.commands_clients,
                                   s.serve.commands_readers, s.wall.input.keys};
  for (const ContentEntry& content : contentsOf(s.wall)) read.push_back(content.path);
  for (const render::out::OutputSettings& output : s.wall.outputs)
    read.push_back(output.correction.mpcdi);
  for (const std::string& other : read) {
    std::error_code error;
    if (other.empty() || !std::filesystem::equivalent(other, path, error)) continue;
    loaded.addFinding(
        at, fmt::format("names {}, which the daemon also reads; it would be overwritten", other));
  }
}

void checkRenderer(LoadedSettings& loaded) {
  const render::gl::GlSettings& gl = loaded.settings.wall.render.gl;
  if (const auto there = render::gl::checkGpu(gl.backend, gl.gpu); !there)
    loaded.addFinding("/wall/render/gpu", there.error().what);
}

void checkOutputs(LoadedSettings& loaded, bool is_start) {
  const WallSettings wall = loaded.settings.wall;
  for (std::size_t i = 0; i < wall.outputs.size(); ++i) {
    checkMeasured(loaded, i, is_start);
    if (const auto there = render::out::checkIsThere(wall.outputs[i].kind); !there) {
      loaded.addFinding(
          fmt::format("/wall/outputs/{}/kind", i),
          fmt::format("cannot be {}: {}", nameOf(wall.outputs[i].kind), there.error().what));
    }
    const std::string& path = wall.outputs[i].path;
    if (path.empty()) continue;
    const std::string at = fmt::format("/wall/outputs/{}/path", i);
    checkReplacesNothing(loaded, path, at);
    checkIsPicture(loaded, path, at);
    if (const auto writable = checkWritable(path); !writable)
      loaded.addFinding(at, kCannot + writable.error().what);
  }
  if (!wall.snapshots.empty()) {
    if (const auto usable = checkFolder(wall.snapshots); !usable)
      loaded.addFinding("/wall/snapshots", kCannot + usable.error().what);
  }
  if (!wall.shown.folder.empty()) {
    if (const auto usable = checkFolder(wall.shown.folder); !usable)
      loaded.addFinding("/wall/shown/folder", kCannot + usable.error().what);
  }
}

}  // namespace merlin::wall
