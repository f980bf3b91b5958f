// Port (an interface): something drawn over a finished frame before its correction: the pointer's
// disc, a test card, the operator's text.
#pragma once

#include <cstdint>
#include <span>

namespace merlin::render::frame {

// Thread-bound to the wall's thread.
class Overlay {
 public:
  virtual ~Overlay() = default;

  // Returns whether draw() would now draw something else than it did last.
  virtual bool hasChanged() const = 0;

  // Draws into the canvas: RGBA of the plan's frame.
  virtual void draw(std::span<std::uint8_t> canvas) = 0;

  // Restores the pixels that draw() changed. REQUIRES: nobody has written to the canvas since
  // draw(), apart from overlays that are already erased.
  virtual void erase(std::span<std::uint8_t> canvas) = 0;
};

}  // namespace merlin::render::frame
