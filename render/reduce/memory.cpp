#include "render/reduce/memory.h"

#include <algorithm>

#include <fmt/format.h>

namespace merlin::render::reduce {
namespace {

// Bytes per triangle for the records and stars of the cost `quadric`, without channels: 64 bytes
// per vertex for its record, about as much for its star, and unused room that growing stars leave.
constexpr double kQuadrics = 84;
constexpr double kPattern = 165;  // bytes per triangle for the cost `pattern`
// Safety factor: the blocks may keep up to 25 % more triangles than requested.
constexpr double kOver = 1.25;
constexpr std::size_t kMostBlocks = 64;

double asDouble(std::size_t n) { return static_cast<double>(n); }

// Returns the size of a mesh with its features, in bytes per triangle.
double meshBytes(const mesh::MeshSize& size) {
  return asDouble(size.bytes()) / asDouble(std::max<std::size_t>(size.triangles, 1));
}

double quadricBytes(const mesh::MeshSize& size) {
  const double vertices =
      asDouble(size.vertices) / asDouble(std::max<std::size_t>(size.triangles, 1));
  // Every feature value except the normal's three may become a channel. A channel takes four floats
  // per vertex; a vertex with channels takes one more float.
  const double channels = size.values > 3 ? 4 * (1 + 4 * asDouble(size.values - 3)) : 0;
  return kQuadrics + vertices * channels;
}

double logBytes(const mesh::MeshSize& size) {
  return asDouble(size.vertices) * (24 + 4 * asDouble(size.values));
}

// Returns an upper bound of the share of the triangles (0..1) that the blocks leave for the final
// reduction.
double shareLeft(const mesh::MeshSize& size, const ReduceSettings& settings) {
  const double target = std::max(
      asDouble(settings.min_triangles) / asDouble(std::max<std::size_t>(size.triangles, 1)),
      settings.min_percent / 100);
  return shareOfBlocks(target) * kOver;
}

// Returns the peak memory in bytes: the maximum of cutting the mesh, reducing a block, joining the
// blocks' logs, and the final reduction of what the blocks leave.
std::size_t needInBlocks(const mesh::MeshSize& size, const ReduceSettings& settings,
                         double blocks) {
  const double v = asDouble(size.vertices), t = asDouble(size.triangles), log = logBytes(size);
  const double each = quadricBytes(size) + meshBytes(size);
  const double left = shareLeft(size, settings);
  const double block = 8 * v + log * 0.9 + each * t * 1.05 / blocks;
  const double joined = 4 * v + 1.8 * log;
  const double whole = log + 12 * v * left + each * t * left;
  return static_cast<std::size_t>(std::max({20 * v, block, joined, whole}));
}

// Returns the peak memory, in bytes, of all steps of a job except the reduction. The steps are
// reading (takes the file, and the mesh without normals), splitting non-manifold edges and vertices
// (takes half-edges and fans of triangles), and writing (takes the collapse log and the order of
// its rows).
std::size_t needOfOtherSteps(const mesh::MeshSize& m, std::size_t file_size) {
  const std::size_t read = m.bytes() - 12 * m.vertices;
  const std::size_t split = read + 36 * m.triangles + 5 * m.vertices;
  const std::size_t write =
      m.bytes() + m.vertices * (24 + 4 * m.values) + 12 * m.vertices + 6 * m.triangles;
  return kProgramBytes + std::max({file_size + read, split, write});
}

}  // namespace

double shareOfBlocks(double target) {
  return std::max(1.0 / 6, std::min(3 * target, (1 + target) / 2));
}

ReductionNeed needOf(const mesh::MeshSize& size, const ReduceSettings& settings) {
  if (settings.cost != "quadric") {
    const auto need = static_cast<std::size_t>(kPattern * asDouble(size.triangles));
    return {need, need};
  }
  const double v = asDouble(size.vertices);
  ReductionNeed need;
  need.whole =
      static_cast<std::size_t>(std::max(quadricBytes(size) * asDouble(size.triangles), 20 * v));
  need.least = std::min(need.whole, needInBlocks(size, settings, kMostBlocks));
  return need;
}

JobNeed needOfJob(const mesh::MeshSize& size, std::size_t file_size,
                  const ReduceSettings& settings) {
  JobNeed need;
  need.besides = size.bytes() + kProgramBytes;
  need.least =
      std::max(needOfOtherSteps(size, file_size), need.besides + needOf(size, settings).least);
  return need;
}

Result<std::size_t> blocksFor(const mesh::MeshSize& size, const ReduceSettings& settings) {
  const ReductionNeed need = needOf(size, settings);
  if (settings.memory == 0 || need.whole <= settings.memory) return std::size_t{1};
  std::size_t blocks = 2;
  while (blocks < kMostBlocks && needInBlocks(size, settings, asDouble(blocks)) > settings.memory)
    ++blocks;
  if (need.least <= settings.memory) return blocks;
  return Error{Errc::kInvalidArgument,
               fmt::format("the reduction of {} triangles takes {} bytes in addition to the mesh, "
                           "at least {} if the mesh is cut into blocks; the limit leaves {}",
                           size.triangles, need.whole, need.least, settings.memory)};
}

}  // namespace merlin::render::reduce
