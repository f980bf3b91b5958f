#include "render/mesh/coincident.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>

namespace merlin::render::mesh {

std::vector<std::uint32_t> coincidentVerticesBySorting(std::span<const float> positions) {
  const std::size_t n = positions.size() / 3;
  std::vector<std::uint32_t> next(n), order(n);
  std::iota(order.begin(), order.end(), 0U);
  const auto at = [&](std::uint32_t v) { return positions.data() + 3 * std::size_t{v}; };
  const auto same = [&](std::uint32_t a, std::uint32_t b) {
    return std::equal(at(a), at(a) + 3, at(b));
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const bool before = std::lexicographical_compare(at(a), at(a) + 3, at(b), at(b) + 3);
    return before || (a < b && same(a, b));
  });
  for (std::size_t first = 0, i = 0; i < n; ++i) {
    const bool last = i + 1 == n || !same(order[i], order[i + 1]);
    next[order[i]] = last ? order[first] : order[i + 1];
    if (last) first = i + 1;
  }
  return next;
}

namespace {

std::size_t tableSize(std::size_t vertices) { return std::bit_ceil(2 * vertices + 1); }

}  // namespace

std::size_t bytesForCoincident(std::size_t vertices) {
  return sizeof(std::uint32_t) * (vertices + tableSize(vertices));
}

// Uses a hash table with open addressing. Its entries are positions; each holds the last vertex
// found there so far, whose next vertex is the first one.
std::vector<std::uint32_t> coincidentVertices(std::span<const float> positions) {
  constexpr std::uint32_t kEmpty = ~std::uint32_t{0};
  const std::size_t n = positions.size() / 3;
  std::vector<std::uint32_t> next(n), last(tableSize(n), kEmpty);
  std::iota(next.begin(), next.end(), 0U);
  const auto at = [&](std::uint32_t v) { return positions.data() + 3 * std::size_t{v}; };
  // If more probes than this are needed, the positions were crafted to collide.
  std::size_t steps_left = 16 * n + 1024;
  for (std::uint32_t v = 0; v < n; ++v) {
    std::size_t k = hashOfPlace(at(v)) & (last.size() - 1);
    while (last[k] != kEmpty && !std::equal(at(v), at(v) + 3, at(last[k]))) {
      k = (k + 1) & (last.size() - 1);
      if (--steps_left > 0) continue;
      next = std::vector<std::uint32_t>();  // frees memory for sorting
      last = std::vector<std::uint32_t>();
      return coincidentVerticesBySorting(positions);
    }
    if (last[k] != kEmpty) {
      next[v] = next[last[k]];
      next[last[k]] = v;
    }
    last[k] = v;
  }
  return next;
}

}  // namespace merlin::render::mesh
