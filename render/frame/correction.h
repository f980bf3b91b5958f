// Port (an interface): turns the canvas into the signal of one output: warp, blend and colour
// correction.
#pragma once

#include <span>

#include "render/out/output.h"

namespace merlin::render::frame {

// One object per output. Thread-bound to the wall's thread.
class Correction {
 public:
  virtual ~Correction() = default;

  // Returns the signal that makes the output's screen look like the canvas. Its pixels stay valid
  // until the next call.
  virtual out::Signal apply(const out::Signal& canvas) = 0;

  // Returns whether the next draw() can draw into the output's memory, so that the output is to be
  // asked for places.
  virtual bool canDraw() { return false; }
  // Draws the signal that apply() would return into all these places of the output (at least one),
  // waits until drawing has finished, and returns it with Signal::drawn set. If it cannot draw
  // there, it returns what apply() returns. To be called after canDraw() returned true.
  virtual out::Signal draw(const out::Signal& canvas, std::span<const out::DrawPlace> /*places*/) {
    return apply(canvas);
  }

  // Returns whether apply() would return a different signal for the same canvas than it did last.
  virtual bool hasChanged() const { return false; }
};

}  // namespace merlin::render::frame
