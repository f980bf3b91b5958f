#include "render/reduce/pattern/edge_heap.h"

#include <cassert>
#include <numeric>
#include <utility>

namespace merlin::render::reduce {

EdgeHeap::EdgeHeap(std::vector<float> lengths)
    : lengths_(std::move(lengths)), heap_(lengths_.size()), place_(lengths_.size()) {
  std::iota(heap_.begin(), heap_.end(), 0U);
  std::iota(place_.begin(), place_.end(), 0U);
  for (std::size_t i = heap_.size() / 2; i-- > 0;) down(i);
}

void EdgeHeap::put(std::size_t place, std::uint32_t edge) noexcept {
  heap_[place] = edge;
  place_[edge] = static_cast<std::uint32_t>(place);
}

void EdgeHeap::up(std::size_t place) noexcept {
  const std::uint32_t edge = heap_[place];
  while (place > 0 && before(edge, heap_[(place - 1) / 2])) {
    put(place, heap_[(place - 1) / 2]);
    place = (place - 1) / 2;
  }
  put(place, edge);
}

void EdgeHeap::down(std::size_t place) noexcept {
  const std::uint32_t edge = heap_[place];
  for (;;) {
    std::size_t child = 2 * place + 1;
    if (child >= heap_.size()) break;
    if (child + 1 < heap_.size() && before(heap_[child + 1], heap_[child])) ++child;
    if (!before(heap_[child], edge)) break;
    put(place, heap_[child]);
    place = child;
  }
  put(place, edge);
}

void EdgeHeap::update(std::uint32_t edge, float length) {
  assert(contains(edge));
  lengths_[edge] = length;
  up(place_[edge]);
  down(place_[edge]);
}

void EdgeHeap::remove(std::uint32_t edge) {
  if (!contains(edge)) return;
  const std::size_t place = place_[edge];
  const std::uint32_t last = heap_.back();
  heap_.pop_back();
  place_[edge] = kGone;
  if (last == edge) return;
  put(place, last);
  up(place);
  down(place_[last]);
}

}  // namespace merlin::render::reduce
