#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/files.h"
#include "daemon/cli/mesh/about_text.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/print.h"
#include "render/lod/finest_level.h"
#include "render/lod/io/mrm_file.h"

namespace merlin::cli {

Result<render::lod::Dendrogram> openModel(const std::string& path, render::mesh::Origin* origin) {
  if (path.ends_with(".mrm")) {
    auto model = render::lod::readMrm(path);
    if (model && origin) *origin = originIn(model->arrays().about);
    return model;
  }
  const auto loaded = loadMesh(path);
  if (!loaded) return loaded.error();
  if (origin) *origin = loaded->origin;
  return render::lod::oneLevel(loaded->mesh);
}

Result<render::mesh::LoadedMesh> loadMesh(const std::string& path) {
  auto loaded = render::mesh::readMesh(path);
  if (!loaded) return loaded;
  for (const std::string& note : loaded->notes) printNote(note);
  render::mesh::ensureNormals(loaded->mesh);
  return loaded;
}

std::vector<Repair> repairsOf(const render::mesh::LoadedMesh& loaded) {
  const render::mesh::TidyReport& t = loaded.tidied;
  const render::mesh::SplitReport& s = loaded.split;
  return {{"degenerate_dropped", "degenerate triangles (same vertex twice) dropped", t.degenerate},
          {"duplicates_dropped", "duplicate triangles dropped", t.duplicate},
          {"opposites_dropped",
           "triangles with the same vertices as another in reverse order dropped", t.opposite},
          {"unused_dropped", "unused vertices dropped", t.unused},
          {"non_manifold_edges", "non-manifold edges split", s.edges},
          {"non_manifold_vertices", "non-manifold vertices split", s.vertices},
          {"vertices_added", "vertices added by splitting", s.added}};
}

std::string mendedText(const render::mesh::LoadedMesh& loaded) {
  std::string text;
  for (const Repair& r : repairsOf(loaded)) {
    if (r.count > 0)
      text += fmt::format("{}{} {}", text.empty() ? "repaired: " : ", ", r.count, r.name);
  }
  return text;
}

Error hasOneResolution(const std::string& path) {
  const std::string advice =
      path.ends_with(".mrm")
          ? ""
          : fmt::format(
                " (first make a multiresolution model of it: merlin mesh reduce {} -o OUT.mrm)",
                path);
  return {Errc::kInvalidArgument, path + ": has one resolution only" + advice};
}

void printWritten(const render::mesh::WrittenMesh& written) {
  if (!written.companions.empty())
    printOut("  companion files: {}\n", fmt::join(written.companions, " and "));
  if (!written.left_out.empty())
    printOut("  features left out, because the format .{} cannot store them: {}\n", written.format,
             fmt::join(written.left_out, ", "));
}

bool hasOrigin(const render::mesh::Origin& origin, bool local,
               const render::mesh::WrittenMesh& written) {
  const render::mesh::Origin none{};
  return origin != none && !local && written.relative_to == none;
}

void printOrigin(const render::mesh::Origin& origin, bool local,
                 const render::mesh::WrittenMesh& written) {
  if (origin == render::mesh::Origin{}) return;
  const std::string at = fmt::format("{}, {}, {}", origin[0], origin[1], origin[2]);
  if (hasOrigin(origin, local, written))
    printOut("  origin    {} is added to the coordinates; --local leaves it out\n", at);
  else if (local)
    printOut("  origin    {} is left out (--local); the mesh's (0, 0, 0) lies there\n", at);
  else
    printOut(
        "  origin    {} is left out, because the numbers of .{} are floats, which keep seven "
        "digits; the mesh's (0, 0, 0) lies there\n",
        at, written.format);
}

void addLocal(Command command, bool& local) {
  command.flag("--local", local,
               "Keep the coordinates of a mesh of a map or a survey relative to its origin, which "
               "is printed, for programs that read coordinates as floats");
}

Error localIsForMeshes(const std::string& output) {
  return {Errc::kInvalidArgument,
          output +
              ": --local is for meshes; a model (.mrm) keeps the origin beside its coordinates, "
              "and a range image (.pgm) its camera: leave the option out"};
}

Result<Ok> checkOutputs(const std::string& input, std::initializer_list<std::string> outputs) {
  std::error_code absent;
  for (const std::string& output : outputs) {
    if (std::filesystem::equivalent(input, output, absent))
      return Error{Errc::kInvalidArgument, output + ": is an input; choose another output file"};
  }
  return checkWritable(outputs);
}

Result<Ok> checkIsThere(const std::string& path) {
  std::error_code absent;
  if (std::filesystem::exists(path, absent)) return Ok{};
  // The same text as in the errors of the readers.
  return Error{Errc::kNotFound, path + ": No such file or directory"};
}

Result<Ok> setWeight(const std::string& text, render::reduce::Weights& weights) {
  const auto equals = text.find('=');
  char* end = nullptr;
  const char* number = text.c_str() + (equals == std::string::npos ? text.size() : equals + 1);
  const float weight = std::strtof(number, &end);
  if (equals == 0 || equals == std::string::npos || end == number || *end != '\0') {
    return Error{Errc::kInvalidArgument, fmt::format("--weight {}: is not FEATURE=NUMBER", text)};
  }
  weights[text.substr(0, equals)] = weight;
  return Ok{};
}

Command LevelChoice::addTo(Command command) {
  Command group = command.group("resolution", "Selects a resolution; the default is the finest");
  group.option("--percent", percent, "Number of triangles, in percent of the finest")
      .range(0.0, 100.0);
  group.option("--triangles", triangles, "Maximum number of triangles");
  group
      .option("--error", error_percent,
              "Maximum error estimate, in percent of the diagonal of the bounding box; selects the "
              "coarsest resolution whose estimate is not larger")
      .nonNegative();
  group.option("--error-units", error_units, "Maximum error estimate, in the model's units")
      .nonNegative();
  group.atMostOne();
  return group;
}

std::size_t LevelChoice::coarsestAllowed(const render::lod::Dendrogram& model) const {
  if (triangles) return model.levelFor(*triangles);
  if (percent)
    return model.levelFor(static_cast<std::size_t>(
        std::floor(*percent / 100 * static_cast<double>(model.triangleCount()))));
  if (error_percent) {
    return model.levelForError(static_cast<float>(*error_percent / 100) *
                               render::lod::finestBox(model).diagonal());
  }
  if (error_units) return model.levelForError(static_cast<float>(*error_units));
  return 0;
}

Result<std::size_t> LevelChoice::levelOf(const render::lod::Dendrogram& model,
                                         const std::string& path) const {
  const std::size_t level = coarsestAllowed(model);
  const double asked =
      triangles ? static_cast<double>(*triangles)
                : percent.value_or(100) / 100 * static_cast<double>(model.triangleCount());
  const std::size_t got = model.trianglesAt(level);
  const bool missed = std::floor(asked) < static_cast<double>(got);
  if (model.levels() == 1 && (missed || error_percent || error_units))
    return hasOneResolution(path);
  if (missed) printNote(fmt::format("{}: the coarsest resolution has {} triangles", path, got));
  return level;
}

}  // namespace merlin::cli
