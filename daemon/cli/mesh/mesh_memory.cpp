#include "daemon/cli/mesh/mesh_memory.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "daemon/base/process_memory.h"
#include "render/image/image_file.h"
#include "render/mesh/io/mesh_file.h"
#include "render/reduce/memory.h"

namespace merlin::cli {
namespace {

// Peak memory per triangle for the lengths, the bands and the drawing of its edges [bytes].
// Measured with a million triangles: 2.1 kB.
constexpr std::size_t kBytesPerTriangleOfEdges = 2300;

}  // namespace

std::size_t memoryLimit(std::uint64_t option) { return option > 0 ? option : freeMemory(); }

std::string sizeText(std::size_t bytes) {
  const double mib = static_cast<double>(bytes) / (1 << 20);
  return mib < 1000 ? fmt::format("{:.0f} MiB", mib) : fmt::format("{:.1f} GiB", mib / 1024);
}

std::size_t roomBeside(const render::mesh::Mesh& mesh, std::size_t others, std::size_t limit) {
  const std::size_t used =
      render::reduce::kProgramBytes + sizeOf(mesh).bytes() + mesh.texture.size() + others;
  return limit - std::min(limit, used);
}

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

Result<Ok> roomForEdges(const std::string& path, std::size_t triangles, std::size_t limit) {
  const std::size_t need = render::reduce::kProgramBytes + triangles * kBytesPerTriangleOfEdges;
  if (need <= limit) return Ok{};
  return Error{Errc::kInvalidArgument,
               fmt::format("{}: drawing the edges of {} triangles takes {}; the limit (--memory, "
                           "by default the free memory) is {}: allow more, or draw a lower "
                           "resolution with --percent",
                           path, triangles, sizeText(need), sizeText(limit))};
}

namespace {

// Returns the size of the decoded texture images [bytes]; images that cannot be decoded count as 0.
std::size_t bytesOf(const std::vector<std::string>& pictures) {
  std::size_t sum = 0;
  for (const std::string& path : pictures) {
    const auto bytes = render::image::imageBytes(path);
    sum += bytes ? *bytes : 0;
  }
  return sum;
}

std::size_t fileSize(const std::string& path) {
  std::error_code unknown;
  const auto bytes = std::filesystem::file_size(path, unknown);
  return unknown ? 0 : bytes;
}

// Returns the peak memory of reading a mesh [bytes]: the program and the mesh, and in addition the
// larger of (file, temporary data and images) and (repairs). Joining several images into one takes
// three times their size.
std::size_t needToRead(const render::mesh::MeshFileSize& size, std::size_t file_bytes,
                       std::size_t picture_bytes) {
  const std::size_t kept = size.mesh.bytes();
  const std::size_t images = size.pictures.size() > 1 ? 3 * picture_bytes : picture_bytes;
  const std::size_t repairs = 36 * size.mesh.triangles + 5 * size.mesh.vertices;
  return render::reduce::kProgramBytes + kept +
         std::max(file_bytes + size.meanwhile + images, repairs);
}

}  // namespace

Result<Ok> roomToRead(const std::string& path, const std::string& named, std::size_t limit) {
  const auto found = render::mesh::meshFileSize(path);
  if (!found) return Ok{};  // the reader will report the fault
  const std::size_t pictures = bytesOf(found->pictures);
  const std::size_t need = needToRead(*found, fileSize(path), pictures);
  if (need <= limit) return Ok{};
  const std::string images =
      pictures > 0 ? fmt::format(" and {} texture images", found->pictures.size()) : "";
  return Error{Errc::kInvalidArgument,
               fmt::format("{}: reading its {} vertices, {} triangles{} takes {}; the limit "
                           "(--memory, by default the free memory) is {}: allow more, or divide "
                           "the mesh",
                           named, found->mesh.vertices, found->mesh.triangles, images,
                           sizeText(need), sizeText(limit))};
}

Result<Ok> checkRoom(const std::string& path, const render::reduce::ReduceSettings& settings,
                     std::size_t limit) {
  auto found = render::mesh::meshFileSize(path);
  if (!found) return Ok{};  // loadMesh() will report the fault
  render::mesh::MeshSize& size = found->mesh;
  size.values += 3;  // three values per vertex for the normals that loadMesh() adds
  for (const std::string& picture : found->pictures) {
    if (const auto fits = roomForPicture(picture, size, limit); !fits) return fits;
  }
  const auto room = roomForReduction(size, fileSize(path) + found->meanwhile, settings, limit);
  if (!room) return Error{room.error().code, path + ": " + room.error().what};
  return Ok{};
}

}  // namespace merlin::cli
