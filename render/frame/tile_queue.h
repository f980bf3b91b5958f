// TileQueue: hands out tiles one after another to several threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

namespace merlin::render::frame {

// take() and done() are thread-safe; begin() may only be called while no thread uses the queue.
class TileQueue {
 public:
  // Starts anew. `tiles`: indices in the plan, in the order in which take() returns them; after the
  // last one take() returns kNone. Each taken tile is to be reported by done().
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

}  // namespace merlin::render::frame
