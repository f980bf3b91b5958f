#include "render/mesh/atlas/pack.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>

namespace merlin::render::mesh {
namespace {

// The free edge of the rectangles placed so far, as steps from left to right.
class Skyline {
 public:
  explicit Skyline(int width) : width_(width), steps_{{0, width, 0}} {}

  // Places a rectangle where its far edge has the lowest y, and among equal ones leftmost.
  // REQUIRES: the rectangle is not wider than the skyline.
  Packing::Place place(RectangleSize size) {
    std::size_t best = 0;
    int best_y = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < steps_.size() && steps_[i].x + size.width <= width_; ++i) {
      const int y = heightAt(i, size.width);
      if (y < best_y) {
        best = i;
        best_y = y;
      }
    }
    const Packing::Place at{steps_[best].x, best_y};
    raise(best, size, best_y + size.height);
    return at;
  }

 private:
  struct Step {
    int x, width, y;
  };

  // Returns the y at which a rectangle of this width comes to rest if its left edge is at step
  // `first`.
  int heightAt(std::size_t first, int width) const {
    int y = 0;
    for (std::size_t i = first; width > 0; ++i) {
      y = std::max(y, steps_[i].y);
      width -= steps_[i].width;
    }
    return y;
  }

  void raise(std::size_t first, RectangleSize size, int y) {
    const int x = steps_[first].x, end = x + size.width;
    std::size_t last = first;  // index after the last step that is covered completely
    while (last < steps_.size() && steps_[last].x + steps_[last].width <= end) ++last;
    if (last < steps_.size()) {
      Step& cut = steps_[last];
      const int covered = std::max(0, end - cut.x);
      cut.x += covered;
      cut.width -= covered;
    }
    const auto at = steps_.begin() + static_cast<std::ptrdiff_t>(first);
    steps_.erase(at, steps_.begin() + static_cast<std::ptrdiff_t>(last));
    steps_.insert(steps_.begin() + static_cast<std::ptrdiff_t>(first), {x, size.width, y});
  }

  int width_;
  std::vector<Step> steps_;
};

Packing packInto(int width, std::span<const RectangleSize> sizes,
                 const std::vector<std::size_t>& order) {
  Packing packing;
  packing.places.resize(sizes.size());
  Skyline skyline(width);
  for (const std::size_t i : order) {
    const auto at = packing.places[i] = skyline.place(sizes[i]);
    packing.size.width = std::max(packing.size.width, at.x + sizes[i].width);
    packing.size.height = std::max(packing.size.height, at.y + sizes[i].height);
  }
  return packing;
}

// Returns whether a is better than b: its longer side is shorter, or, if these are equal, its area
// is smaller.
bool isBetter(RectangleSize a, RectangleSize b) {
  const int longer = std::max(a.width, a.height), other = std::max(b.width, b.height);
  return longer != other ? longer < other
                         : std::int64_t{a.width} * a.height < std::int64_t{b.width} * b.height;
}

}  // namespace

std::optional<Packing> pack(std::span<const RectangleSize> sizes, int most) {
  double area = 0;
  int widest = 1;
  for (const RectangleSize& s : sizes) {
    area += static_cast<double>(s.width) * s.height;
    widest = std::max(widest, s.width);
    if (s.width > most || s.height > most) return std::nullopt;
  }
  if (area > static_cast<double>(most) * most) return std::nullopt;
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sizes[a].height != sizes[b].height ? sizes[a].height > sizes[b].height
                                              : sizes[a].width > sizes[b].width;
  });
  std::optional<Packing> best;
  for (const double wider : {1.0, 1.1, 1.25, 1.5, 2.0, 1e9}) {
    const double width = std::min(std::ceil(wider * std::sqrt(area)), static_cast<double>(most));
    auto packing = packInto(std::max(widest, static_cast<int>(width)), sizes, order);
    if (packing.size.width > most || packing.size.height > most) continue;
    if (!best || isBetter(packing.size, best->size)) best = std::move(packing);
  }
  return best;
}

}  // namespace merlin::render::mesh
