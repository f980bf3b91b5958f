#include "render/testcard/card_overlay.h"

#include <algorithm>
#include <utility>

namespace merlin::render::testcard {

CardOverlay::CardOverlay(int width, int height, std::vector<CardTile> tiles)
    : width_(width), height_(height), tiles_(std::move(tiles)) {}

void CardOverlay::show(std::optional<Card> card, std::optional<MarkedCorner> mark) {
  std::unique_ptr<Pictures> next;
  if (card) {
    const std::size_t bytes =
        std::size_t{4} * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    next = std::make_unique<Pictures>();
    next->card.resize(bytes);
    next->covered.resize(bytes);
    drawCard(*card, tiles_, mark, next->card, width_);
  }
  std::unique_ptr<Pictures> old, skipped;  // destroyed without the lock
  const std::lock_guard lock(mutex_);
  old = std::move(retired_);
  skipped = std::exchange(next_, std::move(next));
  wanted_ = next_ != nullptr;
  waiting_ = true;
}

void CardOverlay::draw(std::span<std::uint8_t> canvas) {
  if (waiting_) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock) {
      retired_ = std::exchange(shown_, std::move(next_));
      waiting_ = false;
    }
  }
  if (!shown_) return;
  copyTiles(canvas, shown_->covered);
  copyTiles(shown_->card, canvas);
}

void CardOverlay::erase(std::span<std::uint8_t> canvas) {
  if (shown_) copyTiles(shown_->covered, canvas);
}

void CardOverlay::copyTiles(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) const {
  for (const CardTile& t : tiles_) {
    for (int row = t.y; row < t.y + t.height; ++row) {
      const auto at = static_cast<std::size_t>(4) *
                      (static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(t.x));
      std::copy_n(&from[at], 4 * t.width, &to[at]);
    }
  }
}

}  // namespace merlin::render::testcard
