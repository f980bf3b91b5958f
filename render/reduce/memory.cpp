#include "render/reduce/memory.h"

#include <algorithm>

#include <fmt/format.h>

namespace merlin::render {
namespace {

// Bytes a triangle while its quadrics are in memory, beside what channels take: 64 a vertex, about
// as much for its star, and what stars that grow leave unused.
constexpr double kQuadrics = 84;
constexpr double kPattern = 165;
// Upper bound of what reduction in blocks leaves, relative to the number that the blocks were asked
// for.
constexpr double kOver = 1.25;
constexpr std::size_t kMostBlocks = 64;

double asDouble(std::size_t n) { return static_cast<double>(n); }

// Memory of a mesh with its normals and features, per triangle.
double meshBytes(const MeshSize& size) {
  return asDouble(size.bytes()) / asDouble(std::max<std::size_t>(size.triangles, 1));
}

double quadricBytes(const MeshSize& size) {
  const double vertices =
      asDouble(size.vertices) / asDouble(std::max<std::size_t>(size.triangles, 1));
  // All features but the normal may be channels of four floats a value.
  const double channels = size.values > 3 ? 4 * (1 + 4 * asDouble(size.values - 3)) : 0;
  return kQuadrics + vertices * channels;
}

double logBytes(const MeshSize& size) {
  return asDouble(size.vertices) * (24 + 4 * asDouble(size.values));
}

// Share of the mesh that the blocks leave to the reduction of the whole.
double shareLeft(const MeshSize& size, const ReduceSettings& settings) {
  const double target = std::max(
      asDouble(settings.min_triangles) / asDouble(std::max<std::size_t>(size.triangles, 1)),
      settings.min_percent / 100);
  return shareOfBlocks(target) * kOver;
}

// At the worst moment: while a block is reduced, while their logs are joined, while what is left
// is.
std::size_t needInBlocks(const MeshSize& size, const ReduceSettings& settings, double blocks) {
  const double v = asDouble(size.vertices), t = asDouble(size.triangles), log = logBytes(size);
  const double each = quadricBytes(size) + meshBytes(size);
  const double left = shareLeft(size, settings);
  const double block = 8 * v + log * 0.9 + each * t * 1.05 / blocks;
  const double joined = 4 * v + 1.8 * log;
  const double whole = log + 12 * v * left + each * t * left;
  return static_cast<std::size_t>(std::max({20 * v, block, joined, whole}));
}

}  // namespace

double shareOfBlocks(double target) {
  return std::max(1.0 / 6, std::min(3 * target, (1 + target) / 2));
}

ReductionNeed needOf(const MeshSize& size, const ReduceSettings& settings) {
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

Result<std::size_t> blocksFor(const MeshSize& size, const ReduceSettings& settings) {
  const ReductionNeed need = needOf(size, settings);
  if (settings.memory == 0 || need.whole <= settings.memory) return std::size_t{1};
  std::size_t blocks = 2;
  while (blocks < kMostBlocks && needInBlocks(size, settings, asDouble(blocks)) > settings.memory)
    ++blocks;
  if (need.least <= settings.memory) return blocks;
  return Error{Errc::kInvalidArgument,
               fmt::format("the reduction of {} triangles takes {} bytes beside the mesh, {} where "
                           "it is cut into blocks; the limit leaves {}",
                           size.triangles, need.whole, need.least, settings.memory)};
}

}  // namespace merlin::render
