#include "render/mesh/places.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace merlin::render {

std::vector<std::uint32_t> samePlace(std::span<const float> positions) {
  const std::size_t n = positions.size() / 3;
  std::vector<std::uint32_t> order(n), next(n);
  std::iota(order.begin(), order.end(), 0U);
  std::iota(next.begin(), next.end(), 0U);
  const auto at = [&](std::uint32_t v) { return positions.data() + 3 * std::size_t{v}; };
  const auto same = [&](std::uint32_t a, std::uint32_t b) {
    return std::equal(at(a), at(a) + 3, at(b));
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float *p = at(a), *q = at(b);
    for (int k = 0; k < 3; ++k) {
      if (p[k] != q[k]) return p[k] < q[k];
    }
    return a < b;
  });
  for (std::size_t first = 0, end = 0; first < n; first = end) {
    for (end = first + 1; end < n && same(order[first], order[end]); ++end)
      next[order[end - 1]] = order[end];
    next[order[end - 1]] = order[first];
  }
  return next;
}

}  // namespace merlin::render
