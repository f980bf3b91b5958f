#include "render/reduce/pattern/list_pool.h"

#include <algorithm>
#include <cassert>

namespace merlin::render::reduce {

ListPool::ListPool(std::span<const std::uint32_t> counts) : at_(counts.size()) {
  std::uint64_t offset = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    at_[i] = {offset, 0, counts[i]};
    offset += counts[i];
  }
  pool_.resize(offset);
}

void ListPool::append(std::size_t list, std::uint32_t number) {
  At& at = at_[list];
  assert(at.size < at.room);
  pool_[at.offset + at.size++] = number;
}

void ListPool::remove(std::size_t list, std::uint32_t number) {
  At& at = at_[list];
  std::uint32_t* begin = pool_.data() + at.offset;
  std::uint32_t* found = std::find(begin, begin + at.size, number);
  if (found == begin + at.size) return;
  std::copy(found + 1, begin + at.size, found);
  --at.size;
}

void ListPool::assign(std::size_t list, std::span<const std::uint32_t> numbers) {
  At& at = at_[list];
  if (numbers.size() > at.room) {
    holes_ += at.room;
    at = {pool_.size(), 0, static_cast<std::uint32_t>(numbers.size())};
    pool_.resize(pool_.size() + numbers.size());
  }
  std::copy(numbers.begin(), numbers.end(), pool_.begin() + static_cast<std::ptrdiff_t>(at.offset));
  at.size = static_cast<std::uint32_t>(numbers.size());
  if (holes_ > pool_.size() / 2) pack();
}

void ListPool::pack() {
  std::vector<std::uint32_t> packed;
  packed.reserve(pool_.size() - holes_);
  for (At& at : at_) {
    const auto from = pool_.begin() + static_cast<std::ptrdiff_t>(at.offset);
    at = {packed.size(), at.size, at.size};
    packed.insert(packed.end(), from, from + at.size);
  }
  pool_ = std::move(packed);
  holes_ = 0;
}

}  // namespace merlin::render::reduce
