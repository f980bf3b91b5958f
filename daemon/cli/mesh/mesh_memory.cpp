#include "daemon/cli/mesh/mesh_memory.h"

#include <filesystem>

#include <fmt/format.h>

#include "render/image/image_file.h"
#include "render/mesh/io/mesh_file.h"
#include "render/reduce/memory.h"

namespace merlin::cli {
namespace {

// A number of bytes as a text for a person, "7.5 GiB".
std::string sizeText(std::size_t bytes) {
  const double mib = static_cast<double>(bytes) / (1 << 20);
  return mib < 1000 ? fmt::format("{:.0f} MiB", mib) : fmt::format("{:.1f} GiB", mib / 1024);
}

}  // namespace

Result<std::size_t> roomForReduction(const render::mesh::MeshSize& mesh, std::size_t file_size,
                                     const render::reduce::ReduceSettings& settings,
                                     std::size_t limit) {
  const render::reduce::JobNeed need = render::reduce::needOfJob(mesh, file_size, settings);
  if (need.least <= limit) return limit - need.besides;
  return Error{Errc::kInvalidArgument,
               fmt::format("reducing {} vertices and {} triangles takes {}, even in blocks; the "
                           "limit (--memory, by default the free memory) is {}",
                           mesh.vertices, mesh.triangles, sizeText(need.least), sizeText(limit))};
}

Result<Ok> roomForPicture(const std::string& picture, const render::mesh::MeshSize& mesh,
                          std::size_t limit) {
  const auto pixels = render::image::imageBytes(picture);
  const std::size_t need = mesh.bytes() + render::reduce::kProgramBytes + (pixels ? *pixels : 0);
  if (!pixels || need <= limit) return Ok{};
  return Error{
      Errc::kInvalidArgument,
      fmt::format("{}: decoding this texture while the mesh is in memory takes {}; the limit "
                  "(--memory, by default the free memory) is {}",
                  picture, sizeText(need), sizeText(limit))};
}

Result<Ok> checkRoom(const std::string& path, const render::reduce::ReduceSettings& settings,
                     std::size_t limit) {
  auto found = render::mesh::meshFileSize(path);
  if (!found) return Ok{};  // loadMesh() reports the fault
  render::mesh::MeshSize& size = found->mesh;
  size.values += 3;  // loadMesh() adds normals
  if (!found->picture.empty()) {
    if (const auto fits = roomForPicture(found->picture, size, limit); !fits) return fits;
  }
  std::error_code unknown;
  const auto bytes = std::filesystem::file_size(path, unknown);
  const auto room = roomForReduction(size, unknown ? 0 : bytes, settings, limit);
  if (!room) return Error{room.error().code, path + ": " + room.error().what};
  return Ok{};
}

}  // namespace merlin::cli
