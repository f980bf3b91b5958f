// ListPool: one short list of numbers per vertex, all in one array. A list that outgrows its room
// moves to the end of the array; when more than half of the array is unused, it is compacted.
// Thread-bound.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace merlin::render::reduce {

class ListPool {
 public:
  // Makes counts.size() empty lists; list i has room for counts[i] numbers.
  explicit ListPool(std::span<const std::uint32_t> counts);

  std::span<const std::uint32_t> operator[](std::size_t list) const noexcept {
    return {pool_.data() + at_[list].offset, at_[list].size};
  }

  // Replaces the contents of a list. Amortised O(1) per number. Invalidates every span that
  // operator[] has returned.
  void assign(std::size_t list, std::span<const std::uint32_t> numbers);
  // REQUIRES: the list has fewer than counts[list] numbers
  void append(std::size_t list, std::uint32_t number);
  // removes the first occurrence; the others keep their order
  void remove(std::size_t list, std::uint32_t number);

 private:
  struct At {
    std::uint64_t offset = 0;
    std::uint32_t size = 0, room = 0;
  };
  void pack();

  std::vector<At> at_;
  std::vector<std::uint32_t> pool_;
  std::uint64_t holes_ = 0;
};

}  // namespace merlin::render::reduce
