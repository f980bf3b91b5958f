// Port (an interface): turns the canvas into the signal of one output: warp, blend and colour
// correction.
#pragma once

#include "render/out/output.h"

namespace merlin::render::frame {

// One object per output. Thread-bound to the wall's thread.
class Correction {
 public:
  virtual ~Correction() = default;

  // Returns the signal that makes the output's screen look like the canvas. Its pixels stay valid
  // until the next call.
  virtual out::Signal apply(const out::Signal& canvas) = 0;

  // Whether apply() would return a different signal for the same canvas than it did last.
  virtual bool hasChanged() const { return false; }
};

}  // namespace merlin::render::frame
