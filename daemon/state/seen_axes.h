// SeenAxes: how an output's signal is turned or mirrored before people see it, for example by a
// projector that hangs upside down or projects from behind. It converts between the directions that
// people in front of the wall see and those in the signal. Pure.
#pragma once

#include <cstddef>

#include "daemon/state/alignment.h"

namespace merlin::state {

struct SeenAxes {
  // `right`: direction in the signal of a step to the right on the wall; `down`: that of a step
  // down. In each, one of x and y is 1 or -1 and the other one is 0.
  Offset right{1, 0}, down{0, 1};

  bool operator==(const SeenAxes&) const = default;
  // onSignal() converts an offset as seen on the wall to an offset in the signal; seen() converts
  // it back.
  Offset onSignal(const Offset& seen) const;
  Offset seen(const Offset& on_signal) const;
  // Returns the index of the signal's corner that is seen as the corner `seen` of the wall. Both
  // are indexes into kCornerNames.
  std::size_t cornerOnSignal(std::size_t seen) const;
};

}  // namespace merlin::state
