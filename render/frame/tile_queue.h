// TileQueue: tiles that are handed out one after another to several threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

namespace merlin::render {

// take() and done() are thread-safe; begin() while nobody calls them.
class TileQueue {
 public:
  // Numbers of tiles in the plan, in the order in which they are taken.
  void begin(std::span<const std::size_t> tiles) {
    tiles_.assign(tiles.begin(), tiles.end());
    next_ = done_ = 0;
  }
  static constexpr std::size_t kNone = ~std::size_t{0};
  std::size_t take() noexcept {
    const std::size_t i = next_.fetch_add(1);
    return i < tiles_.size() ? tiles_[i] : kNone;
  }
  void done() noexcept { done_.fetch_add(1); }
  bool allDone() const noexcept { return done_.load() == tiles_.size(); }

 private:
  std::vector<std::size_t> tiles_;
  std::atomic<std::size_t> next_{0}, done_{0};
};

}  // namespace merlin::render
