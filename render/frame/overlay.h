// Port: what is drawn over a finished frame, before correction: the pointer's disc, a test card,
// the operator's text.
#pragma once

#include <cstdint>
#include <span>

namespace merlin::render {

// Thread-bound to the wall's thread.
class Overlay {
 public:
  virtual ~Overlay() = default;

  // Whether draw() would draw something else than it did last.
  virtual bool hasChanged() const = 0;

  // Draws into the canvas: RGBA of the plan's frame.
  virtual void draw(std::span<std::uint8_t> canvas) = 0;

  // Puts the canvas back as draw() found it. REQUIRES: nobody else wrote it since.
  virtual void erase(std::span<std::uint8_t> canvas) = 0;
};

}  // namespace merlin::render
