#include "daemon/import/importers.h"

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "daemon/import/sandbox.h"
#include "render/import/grid_import.h"
#include "render/import/model_file.h"
#include "render/import/vips_pyramid.h"
#include "render/mesh/io/mesh_file.h"
#include "render/points/io/cloud_file.h"
#if defined(MERLIN_POINTS)
#include "render/import/point_surface.h"
#endif

namespace merlin::import {
namespace {

Result<Imported> importPicture(const Request& request, const Reports& reports) {
  const std::string name = "pyramid.tif";
  const auto made = render::import::importPicture(
      request.input, request.folder + "/" + name,
      {request.panorama, request.quality, request.tile_px, request.range},
      {[&](const render::import::ImportedPicture& size) {
         return reports.size(3 * static_cast<std::uint64_t>(size.width) *
                             static_cast<std::uint64_t>(size.height));
       },
       reports.progress, reports.note});
  if (!made) return made.error();
  return Imported{name, fmt::format("\"width\": {}, \"height\": {}", made->width, made->height)};
}

Result<Imported> importModel(const Request& request, const Reports& reports) {
  const std::string name = "model.ply";
  auto built = render::import::readModel(
      {request.input, request.format, request.folder, request.beside}, reports.progress);
  if (!built) return built.error();
  const render::mesh::Mesh& mesh = built->mesh;
  if (const auto valid = validate(mesh); !valid)
    return Error{valid.error().code, request.input + ": " + valid.error().what};
  if (const auto may = reports.size(sizeOf(mesh).bytes() + mesh.texture.size()); !may)
    return may.error();
  const auto written = render::mesh::writeMesh(request.folder + "/" + name, mesh, built->origin);
  if (!written) return written.error();
  for (const std::string& note : built->notes) reports.note(note);
  return Imported{name, fmt::format("\"parts\": {}, \"degenerate\": {}, \"welded_vertices\": {}, "
                                    "\"welded_edges\": {}",
                                    built->parts, built->degenerate, built->welded.vertices,
                                    built->welded.edges)};
}

Result<Imported> importGrid(const Request& request, const Reports& reports) {
  const std::string name = "grid";
  const auto made = render::import::importGrid(
      {request.input, request.hdu, request.variable}, request.folder + "/" + name,
      [&](const render::import::ImportedGrid& size) {
        return reports.size(sizeof(float) * size.width * size.height);
      },
      reports.progress);
  if (!made) return made.error();
  return Imported{name, fmt::format("\"width\": {}, \"height\": {}", made->width, made->height)};
}

// Reads a point cloud. If the file does not fit into the memory that the libraries leave, returns
// the error that asks for more memory.
Result<render::points::PointCloud> readPoints(const std::string& path) {
  auto cloud = render::points::readCloud(path);
  if (!cloud && cloud.error().code == Errc::kNoMemory) return render::import::needsMoreMemory(path);
  return cloud;
}

#if defined(MERLIN_POINTS)

Result<Ok> preparePoints(const char* program) { return render::import::preparePoints(program); }

// Returns a text as a JSON string, after oneLine() has escaped its control characters.
std::string jsonString(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : oneLine(text)) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string factsOf(const render::points::PointCloud& cloud,
                    const render::import::PointSurface& surface) {
  const auto& used = surface.settings;
  const auto& origin = cloud.origin;
  return fmt::format(
      "\"format\": \"{}\", \"points\": {}, \"spacing\": {}, \"depth\": {}, \"neighbours\": {}, "
      "\"trim\": {}, \"trimmed\": {}, \"normals\": \"{}\", "
      "\"origin_x\": {}, \"origin_y\": {}, \"origin_z\": {}, \"projection\": {}",
      cloud.format, cloud.size(), surface.spacing, used.depth, used.neighbours, used.trim,
      surface.trimmed, surface.normals, origin[0], origin[1], origin[2],
      jsonString(cloud.projection));
}

Result<Imported> importPoints(const Request& request, const Reports& reports) {
  const std::string name = "model.ply";
  const auto cloud = readPoints(request.input);
  if (!cloud) return cloud.error();
  const auto surface = render::import::surfaceOf(*cloud, request.surface, reports.progress);
  if (!surface) return Error{surface.error().code, request.input + ": " + surface.error().what};
  const render::mesh::Mesh& mesh = surface->mesh;
  if (const auto valid = validate(mesh); !valid)
    return Error{valid.error().code, request.input + ": " + valid.error().what};
  if (const auto may = reports.size(sizeOf(mesh).bytes()); !may) return may.error();
  const auto written = render::mesh::writeMesh(request.folder + "/" + name, mesh);
  if (!written) return written.error();
  for (const auto* notes : {&cloud->notes, &surface->notes}) {
    for (const std::string& note : *notes) reports.note(note);
  }
  return Imported{name, factsOf(*cloud, *surface)};
}

#else

Result<Ok> preparePoints(const char* /*program*/) { return Ok{}; }

// Reads the file even though no surface can be made, so that a fault of the file is reported first.
Result<Imported> importPoints(const Request& request, const Reports& /*reports*/) {
  const auto cloud = readPoints(request.input);
  if (!cloud) return cloud.error();
  return Error{Errc::kUnsupported, request.input +
                                       ": this merlin-import was built without Open3D, which makes "
                                       "surfaces of points; build it with Open3D (Debian: "
                                       "libopen3d-dev)"};
}

#endif

constexpr Importer kImporters[] = {
    {"picture", "a picture of any format that libvips reads, as a tiled pyramid",
     &render::import::prepareImport, &importPicture},
    {"model", "a model of any format that Coin or assimp reads (--format), as a mesh",
     &render::import::prepareModels, &importModel, &filesBeside},
    {"grid", "a range image or an elevation map of FITS or any format that GDAL reads",
     &render::import::prepareGridImport, &importGrid, &render::import::gridHeadersBeside},
    {"points", "a point cloud (LAS, PCD, PLY, XYZ), as the mesh of a surface through its points",
     &preparePoints, &importPoints},
};

}  // namespace

std::span<const Importer> importers() noexcept { return kImporters; }

}  // namespace merlin::import
