// NumberTable: a small hash table from numbers to numbers. Private to render/reduce.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace merlin::render::reduce {

// The table uses open addressing; expected O(1) per operation. It is scratch memory: use one per
// thread.
class NumberTable {
 public:
  // Removes all keys and makes room for `numbers` keys. Amortised O(1).
  void reset(std::size_t numbers) {
    const std::size_t size = std::bit_ceil(2 * numbers + 1);
    if (entries_.size() < size) {
      entries_.assign(size, {});
      now_ = 0;
    }
    if (++now_ == 0) {
      std::fill(entries_.begin(), entries_.end(), Entry{});
      now_ = 1;
    }
  }

  // Returns the value of the key `number`; a new key is added with the value 0. REQUIRES: no more
  // keys than reset() made room for.
  std::uint32_t& operator[](std::uint32_t number) {
    const std::size_t mask = entries_.size() - 1;
    std::size_t k = (std::uint64_t{number} * 0x9E3779B97F4A7C15U >> 32) & mask;
    while (entries_[k].stamp == now_ && entries_[k].number != number) k = (k + 1) & mask;
    Entry& entry = entries_[k];
    if (entry.stamp != now_) entry = {number, 0, now_};
    return entry.value;
  }

 private:
  struct Entry {
    std::uint32_t number = 0, value = 0, stamp = 0;
  };
  std::vector<Entry> entries_;
  std::uint32_t now_ = 0;
};

}  // namespace merlin::render::reduce
