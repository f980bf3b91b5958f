// DisjointSets: a union-find structure that divides numbers into disjoint sets. Reentrant.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace merlin::render::mesh {

// Initially, each number below `size` is a set of its own. The root of a set is its smallest
// number.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  std::uint32_t rootOf(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // Merges the sets of a and b; returns a member of the merged set.
  std::uint32_t unite(std::uint32_t a, std::uint32_t b) {
    if (parent_[a] == parent_[b]) return parent_[a];  // common for neighbours, and much faster
    a = rootOf(a);
    b = rootOf(b);
    return parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace merlin::render::mesh
