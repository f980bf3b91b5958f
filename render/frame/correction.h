// Port: the stage between the canvas and what an output is sent: warp, blend, colour.
#pragma once

#include "render/out/output.h"

namespace merlin::render {

// One output's. Thread-bound to the wall's thread.
class Correction {
 public:
  virtual ~Correction() = default;

  // The signal that looks as the canvas was meant to, on that output's screen. Its pixels stay
  // valid until the next call.
  virtual Signal apply(const Signal& canvas) = 0;
};

}  // namespace merlin::render
