// merlin mesh info: prints what is in a file that MERLIN reads as a mesh, a model, a range image or
// a point cloud.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/about_text.h"
#include "daemon/cli/mesh/import_grid.h"
#include "daemon/cli/mesh/import_model.h"
#include "daemon/cli/mesh/import_range.h"
#include "daemon/cli/mesh/info_report.h"
#include "daemon/cli/mesh/input_kinds.h"
#include "daemon/cli/mesh/late_bar.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/mesh/mesh_memory.h"
#include "daemon/cli/print.h"
#include "render/mesh/coincident.h"
#include "render/points/io/cloud_file.h"

namespace merlin::cli {
namespace {

struct MeshInfoOptions {
  std::string file;
  RangeImport range;
  std::uint64_t memory = 0;  // limit in bytes; 0: the free memory
  bool json = false;

  std::size_t limit() const { return memoryLimit(memory); }
};

// Returns a path in the folder for temporary files; the work folder of merlin-import is made beside
// it.
std::string meanwhile() {
  std::error_code error;
  const auto folder = std::filesystem::temp_directory_path(error);
  return ((error ? "/tmp" : folder) / "merlin-info").string();
}

void addMesh(const render::mesh::Mesh& mesh, FileInfo& info) {
  info.triangles = mesh.triangleCount();
  info.vertices = mesh.vertexCount();
  info.texture_bytes = mesh.texture.size();
  info.is = render::mesh::inspect(mesh);
  if (info.levels.levels == 1) info.levels.coarsest = info.triangles;
}

void addFeatures(const render::mesh::Mesh& mesh, FileInfo& info) {
  for (const auto& f : mesh.features)
    info.features.push_back({f.name, featureIn(info.about, f.name).unit, f.dimension, rangeOf(f)});
}

void addLoaded(const render::mesh::LoadedMesh& loaded, FileInfo& info) {
  addMesh(loaded.mesh, info);
  addFeatures(loaded.mesh, info);
  info.origin = loaded.origin;
  info.repairs = repairsOf(loaded);
  info.mended = mendedText(loaded);
}

Result<FileInfo> infoOfModel(const std::string& path) {
  const auto model = openModel(path);
  if (!model) return model.error();
  FileInfo info{path, "multiresolution model"};
  const std::size_t last = model->levels() - 1;
  info.levels = {model->levels(), model->trianglesAt(last), model->errorAt(last)};
  info.about = model->arrays().about;
  info.unit = oneLine(valueIn(info.about, "unit"));
  info.origin = originIn(info.about);
  const render::mesh::Mesh mesh = extract(*model, 0);
  addMesh(mesh, info);
  addFeatures(mesh, info);
  info.texture_bytes = model->arrays().texture.size();
  return info;
}

// Returns facts about the mesh as it is in the file; no normals are added.
Result<FileInfo> infoOfMesh(const std::string& path, std::size_t limit) {
  if (const auto fits = roomToRead(path, path, limit); !fits) return fits.error();
  const auto loaded = render::mesh::readMeshByContent(path);
  if (!loaded) return loaded.error();
  for (const std::string& note : loaded->notes) printNote(note);
  FileInfo info{path, "mesh"};
  addLoaded(*loaded, info);
  return info;
}

Result<FileInfo> infoOfForeign(const MeshInfoOptions& options, const InputKind& kind) {
  const std::string& path = options.file;
  const auto model = loadModel(path, kind, {meanwhile(), options.limit()});
  if (!model) return model.error();
  FileInfo info{path, model->format};
  info.unit = kind.unit();
  info.parts = model->parts;
  addLoaded(model->loaded, info);
  return info;
}

// Returns facts about the points themselves; no surface is computed.
Result<FileInfo> infoOfPoints(const std::string& path) {
  auto cloud = render::points::readCloud(path);
  if (!cloud) return cloud.error();
  for (const std::string& note : cloud->notes) printNote(fmt::format("{}: {}", path, note));
  const auto next = render::mesh::coincidentVertices(cloud->positions);
  // Number of different positions: coincident points form a ring, whose last point leads to its
  // first.
  std::size_t places = 0;
  for (std::uint32_t p = 0; p < next.size(); ++p) places += next[p] <= p;
  FileInfo info{path, cloud->format};
  info.cloud = CloudInfo{cloud->size(), cloud->size() - places};
  info.origin = cloud->origin;
  info.projection = cloud->projection;
  render::mesh::Mesh points;
  points.positions = std::move(cloud->positions);
  points.features = std::move(cloud->features);
  info.is = render::mesh::inspect(points);
  addFeatures(points, info);
  return info;
}

void addPlanes(const ImportedRange& range, FileInfo& info) {
  for (const render::range::Plane& plane : range.image.planes) {
    render::mesh::Feature at_returns{plane.name, plane.dimension, {}};
    for (std::size_t i = 0; i < plane.values.size(); ++i) {
      if (render::range::isReturn(range.image.range[i / plane.dimension]))
        at_returns.values.push_back(plane.values[i]);
    }
    info.features.push_back({plane.name, plane.unit, plane.dimension, rangeOf(at_returns)});
  }
}

Result<FileInfo> infoOfRange(const MeshInfoOptions& options, const std::optional<InputKind>& kind) {
  auto range = loadRange(
      options.file, options.range, false,
      readerOf(kind,
               {{}, meanwhile(), options.limit(), options.range.hdu, options.range.variable}));
  if (!range) return range.error();
  for (const std::string& note : range->notes) printNote(options.file + ": " + note);
  FileInfo info{options.file, range->format};
  info.unit = range->in_metres ? "m" : "";
  const render::range::RangeImage& image = range->image;
  info.image = ImageInfo{image.width, image.height, range->returns_in_file,
                         std::string(nameOf(image.geometry.scanner))};
  addPlanes(*range, info);
  const SystemClock clock;
  LateBar bar("inspecting", image.pixels(), clock);
  const auto work = bar.work(0);
  if (const auto fits = filterRange(options.file, options.range, options.limit(), work, *range);
      !fits)
    return fits.error();
  const auto meshed = meshRange(options.file, options.range, work, *range);
  bar.finish();
  if (!meshed) printNote(meshed.error().what);
  if (meshed) addMesh(range->mesh.mesh, info);
  info.origin = range->origin;
  return info;
}

Result<FileInfo> infoOf(const MeshInfoOptions& options) {
  if (const auto there = checkIsThere(options.file); !there) return there.error();
  const std::string option = options.range.scale ? "--scale" : options.range.anyGiven();
  const auto kind = options.range.isRaw() ? std::nullopt : inputKindOf(options.file);
  if (options.range.isRaw() || (kind && kind->isGrid())) return infoOfRange(options, kind);
  if (!option.empty())
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: {} is for range images", options.file, option)};
  if (kind && kind->isPoints()) return infoOfPoints(options.file);
  if (options.file.ends_with(".mrm")) return infoOfModel(options.file);
  return kind && kind->reader == InputReader::kForeign ? infoOfForeign(options, *kind)
                                                       : infoOfMesh(options.file, options.limit());
}

int meshInfo(const MeshInfoOptions& options) {
  const auto found = infoOf(options);
  if (!found) return fail(found.error());
  (options.json ? printInfoJson : printInfoText)(*found);
  return kExitDone;
}

}  // namespace

void addMeshInfo(Command mesh, Run& run) {
  const auto options = std::make_shared<MeshInfoOptions>();
  Command command = mesh.subcommand(
      "info",
      "Show what is in a model, a mesh, a range image, an elevation map, a point cloud, or a model "
      "of another program, whatever merlin mesh import reads: sizes, the box around it, features "
      "with their "
      "ranges, connected parts, holes with the length of their borders, what is odd, and the "
      "repairs that reading needed. Vertices at one place count as one for holes, and for parts "
      "where a surface ends. "
      "Nothing is written."
      "\nExample: merlin mesh info scan.mrm --json");
  command.option("file", options->file, "The file").required().typeName("FILE");
  command
      .option("--scale", options->range.scale,
              "Metres per unit of the ranges or heights of a range image or an elevation map")
      .positive()
      .typeName("METRES_PER_UNIT");
  options->range.addTo(command);
  command
      .option("--memory", options->memory,
              "Maximum memory that reading and meshing may take, such as 900M or 16G; the default "
              "is the free memory")
      .size()
      .typeName("SIZE");
  command.flag("--json", options->json, "Print JSON, for programs");
  command.callback([options, &run] { run = [options] { return meshInfo(*options); }; });
}

}  // namespace merlin::cli
