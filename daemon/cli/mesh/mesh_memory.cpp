#include "daemon/cli/mesh/mesh_memory.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "render/image/image_file.h"
#include "render/mesh/io/mesh_file.h"
#include "render/reduce/memory.h"

namespace merlin::cli {
namespace {

// Memory of the program itself and of its file buffers [bytes].
constexpr std::size_t kProgram = std::size_t{32} << 20;

// A number of bytes as a text for a person, "7.5 GiB".
std::string sizeText(std::size_t bytes) {
  const double mib = static_cast<double>(bytes) / (1 << 20);
  return mib < 1000 ? fmt::format("{:.0f} MiB", mib) : fmt::format("{:.1f} GiB", mib / 1024);
}

// The bytes of address space that the limit (ulimit -v) still allows, less an eighth for addresses
// that the allocator and threads reserve but do not use. A very large number without a limit.
std::size_t freeAddresses() {
  rlimit limit{};
  std::size_t pages = 0;
  std::ifstream used("/proc/self/statm");
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || !(used >> pages))
    return std::numeric_limits<std::size_t>::max();
  const std::size_t taken = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return limit.rlim_cur > taken ? (limit.rlim_cur - taken) / 8 * 7 : 0;
}

// Peak memory, in bytes, of all steps except the reduction. These are: reading (the file, and the
// mesh without normals), splitting non-manifold edges and vertices (half-edges and fans of
// triangles), and writing (the collapse log and the order of its rows).
std::size_t needOfOthers(const render::mesh::MeshSize& m, std::size_t file_size) {
  const std::size_t read = m.bytes() - 12 * m.vertices;
  const std::size_t split = read + 36 * m.triangles + 5 * m.vertices;
  const std::size_t write =
      m.bytes() + m.vertices * (24 + 4 * m.values) + 12 * m.vertices + 6 * m.triangles;
  return kProgram + std::max({file_size + read, split, write});
}

}  // namespace

std::size_t freeMemory() {
  std::ifstream info("/proc/meminfo");
  for (std::string word; info >> word;) {
    std::size_t kib = 0;
    if (word == "MemAvailable:" && info >> kib)
      return std::min(kib * 1024 / 16 * 15, freeAddresses());
  }
  return freeAddresses();
}

std::size_t peakMemory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

Result<std::size_t> roomForReduction(const render::mesh::MeshSize& mesh, std::size_t file_size,
                                     const render::reduce::ReduceSettings& settings,
                                     std::size_t limit) {
  const std::size_t beside = mesh.bytes() + kProgram;
  const std::size_t need =
      std::max(needOfOthers(mesh, file_size), beside + needOf(mesh, settings).least);
  if (need <= limit) return limit - beside;
  return Error{Errc::kInvalidArgument,
               fmt::format("reducing {} vertices and {} triangles takes {}, even in blocks; the "
                           "limit (--memory, by default the free memory) is {}",
                           mesh.vertices, mesh.triangles, sizeText(need), sizeText(limit))};
}

Result<Ok> roomForPicture(const std::string& picture, const render::mesh::MeshSize& mesh,
                          std::size_t limit) {
  const auto pixels = render::image::imageBytes(picture);
  const std::size_t need = mesh.bytes() + kProgram + (pixels ? *pixels : 0);
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
