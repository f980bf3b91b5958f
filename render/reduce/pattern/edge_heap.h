// EdgeHeap: a priority queue of edges by length, shortest first, in which lengths can be updated
// ([GOURLEY98] 4.2.2).
//
// This is a binary heap that also stores the place of each edge in the heap. If two edges have
// equal length, the one with the smaller number comes first, so that the order is the same on every
// machine. Thread-bound.
#pragma once

#include <cstdint>
#include <vector>

namespace merlin::render::reduce {

class EdgeHeap {
 public:
  // Builds a heap of the edges 0 .. lengths.size() - 1; lengths[e] is the length of edge e. O(n).
  explicit EdgeHeap(std::vector<float> lengths);

  bool empty() const noexcept { return heap_.empty(); }
  std::uint32_t top() const noexcept { return heap_.front(); }
  float length(std::uint32_t edge) const noexcept { return lengths_[edge]; }
  bool contains(std::uint32_t edge) const noexcept { return place_[edge] != kGone; }

  void update(std::uint32_t edge, float length);  // O(log n). REQUIRES: contains(edge)
  void remove(std::uint32_t edge);                // O(log n); no effect if not contained

 private:
  static constexpr std::uint32_t kGone = ~std::uint32_t{0};

  bool before(std::uint32_t a, std::uint32_t b) const noexcept {
    return lengths_[a] != lengths_[b] ? lengths_[a] < lengths_[b] : a < b;
  }
  void put(std::size_t place, std::uint32_t edge) noexcept;
  void up(std::size_t place) noexcept;
  void down(std::size_t place) noexcept;

  std::vector<float> lengths_;
  std::vector<std::uint32_t> heap_, place_;
};

}  // namespace merlin::render::reduce
