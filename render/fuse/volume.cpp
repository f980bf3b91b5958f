#include "render/fuse/volume.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace merlin::render::fuse {
namespace {

constexpr unsigned kBits = 20;  // bits of each block coordinate in a key

std::uint64_t keyOf(const Lattice& block) {
  return std::uint64_t{block[2]} << 2 * kBits | std::uint64_t{block[1]} << kBits | block[0];
}
Lattice blockOf(std::uint64_t key) {
  Lattice block;
  for (unsigned k = 0; k < 3; ++k)
    block[k] = static_cast<std::uint32_t>(key >> kBits * k) & ((1U << kBits) - 1);
  return block;
}

// Memory [bytes] of a block with 64 cells of surface, until the mesh with its normals is finished;
// and the additional memory for each float of a feature.
constexpr std::size_t kBlockBytes = 20 << 10, kValueBytes = 1 << 10;

}  // namespace

float Volume::valueAt(const Lattice& corner) const {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const Point p = grid_.at(corner);
  if (!grid_.contains(p)) return settings_.close ? 1 : kUnknown;
  double sum = 0, near = 0, free = 0;
  for (const View& view : views_) {
    const Sight sight = view.at(p);
    if (sight.kind == Sight::Kind::kFree) free += sight.weight;
    if (sight.kind != Sight::Kind::kNear) continue;
    near += sight.weight;
    sum += sight.weight * sight.distance;
  }
  // Scans that saw `p` as free outvote scans that put it inside. This removes spikes and objects
  // that moved between scans.
  const bool outvoted = sum < 0 && free > near;
  if (near > 0 && !outvoted)
    return static_cast<float>(sum / near / (settings_.truncation * grid_.voxel));
  if (!settings_.close) return kUnknown;
  return free > 0 ? 1 : -1;
}

void Volume::findSeeds() {
  for (const View& view : views_) {
    view.forSurfacePoints([&](const Point& p) {
      Lattice block;
      for (std::size_t k = 0; k < 3; ++k)
        block[k] = static_cast<std::uint32_t>((p[k] - grid_.low[k]) / grid_.voxel / kCells);
      if (const std::uint64_t key = keyOf(block); seen_.insert(key).second) queue_.push_back(key);
    });
  }
  std::sort(queue_.begin(), queue_.end());
}

// Computes the values of a block and its surface; returns the sides that the surface crosses, as
// crossedSides() does.
std::uint8_t Volume::fill(std::uint64_t key, Piece& piece) const {
  const Lattice block = blockOf(key);
  Values values;
  std::size_t i = 0;
  for (std::uint32_t z = 0; z < kCorners; ++z) {
    for (std::uint32_t y = 0; y < kCorners; ++y) {
      for (std::uint32_t x = 0; x < kCorners; ++x) {
        constexpr std::uint32_t kStep = kCells;
        values[i++] = valueAt({block[0] * kStep + x, block[1] * kStep + y, block[2] * kStep + z});
      }
    }
  }
  piece = surfaceIn(values, block);
  return crossedSides(values);
}

// Appends the neighbours of blocks to the queue. sides[i]: the crossed sides of block queue_[from +
// i]; the blocks beyond these sides are appended.
void Volume::grow(const std::vector<std::uint8_t>& sides, std::size_t from) {
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (unsigned side = 0; side < 6; ++side) {
      if (!(sides[i] >> side & 1U)) continue;
      Lattice block = blockOf(queue_[from + i]);
      std::uint32_t& x = block[side / 2];
      if (side % 2 == 0 && x == 0) continue;  // no surface lies outside the grid
      x += side % 2 == 0 ? ~0U : 1U;
      if (x >= kMostCorners / kCells - 1) continue;
      if (const std::uint64_t key = keyOf(block); seen_.insert(key).second) queue_.push_back(key);
    }
  }
}

Result<Ok> Volume::checkMemory(std::size_t blocks) const {
  const std::size_t need = blocks * (kBlockBytes + kValueBytes * values_);
  if (need <= settings_.memory) return Ok{};
  const double fits =
      grid_.voxel * std::sqrt(1.3 * static_cast<double>(need) /
                              static_cast<double>(std::max(settings_.memory, std::size_t{1})));
  return Error{Errc::kInvalidArgument,
               fmt::format("voxels of {:.4g} take {} MB in {} blocks; the limit (--memory, by "
                           "default the free memory) leaves {} MB: --voxel {:.3g} would fit",
                           grid_.voxel, need >> 20, blocks, settings_.memory >> 20, fits)};
}

Result<Ok> Volume::run(const range::Work& work) {
  constexpr std::size_t kAtOnce = 1024;  // number of blocks between two checks of the memory limit
  findSeeds();
  if (const auto fits = checkMemory(queue_.size()); !fits) return fits;
  std::size_t done = 0, blocks = 0;
  while (done < queue_.size()) {
    const std::size_t count = std::min(kAtOnce, queue_.size() - done);
    std::vector<Piece> filled(count);
    std::vector<std::uint8_t> sides(count);
    forBlocks(work.threads, count,
              [&](std::size_t i) { sides[i] = fill(queue_[done + i], filled[i]); });
    for (Piece& piece : filled) {
      if (!piece.triangles.empty()) pieces_.push_back(std::move(piece)), ++blocks;
    }
    grow(sides, done);
    done += count;
    if (const auto fits = checkMemory(std::max(blocks, seen_.size() / 16)); !fits) return fits;
    if (work.progress)
      work.progress(static_cast<double>(done) / static_cast<double>(queue_.size()));
  }
  return Ok{};
}

}  // namespace merlin::render::fuse
