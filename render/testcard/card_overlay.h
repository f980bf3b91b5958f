// CardOverlay: draws a test card over all that the wall shows.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "render/frame/overlay.h"
#include "render/testcard/card.h"

namespace merlin::render::testcard {

// show() and isShown() are for any thread; the rest for the wall's.
class CardOverlay final : public frame::Overlay {
 public:
  // `width`, `height`: size of the canvas [px].
  CardOverlay(int width, int height, std::vector<CardTile> tiles);

  // Shows a card from the next frame on, or none. Draws the card in this call, on the calling
  // thread. A card needs memory for two pictures of the canvas's size, which is freed by a later
  // call of show() after the card was removed or replaced.
  void show(std::optional<Card> card, std::optional<MarkedCorner> mark = std::nullopt);

  // Returns whether a card is drawn, or will be with the next frame.
  bool isShown() const noexcept { return wanted_; }

  bool hasChanged() const override { return waiting_; }
  // Costs a copy of the tiles, and erase() another; nothing while no card is shown. Never waits.
  void draw(std::span<std::uint8_t> canvas) override;
  void erase(std::span<std::uint8_t> canvas) override;

 private:
  // The drawn card, and the pixels that it covers; each of the canvas's size.
  struct Pictures {
    std::vector<std::uint8_t> card, covered;
  };
  void copyTiles(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) const;

  int width_, height_;
  std::vector<CardTile> tiles_;
  std::mutex mutex_;  // guards next_ and retired_
  std::unique_ptr<Pictures> next_, retired_;
  std::atomic<bool> waiting_{false}, wanted_{false};
  std::unique_ptr<Pictures> shown_;
};

}  // namespace merlin::render::testcard
