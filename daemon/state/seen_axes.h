// SeenAxes: how an output's signal is turned or mirrored before people see it, as for a projector
// that hangs upside down or projects from behind. People in front of the wall mean left and right
// as they see them. Pure.
#pragma once

#include <cstddef>

#include "daemon/state/alignment.h"

namespace merlin::state {

struct SeenAxes {
  // The direction in the signal of a step to the right, and of a step down, on the wall: in each,
  // one of x and y is 1 or -1, the other 0.
  Offset right{1, 0}, down{0, 1};

  bool operator==(const SeenAxes&) const = default;
  // Converts an offset on the wall to one in the signal, and back.
  Offset onSignal(const Offset& seen) const;
  Offset seen(const Offset& on_signal) const;
  // The signal's corner that is seen in a corner of the wall; in the order of kCornerNames.
  std::size_t cornerOnSignal(std::size_t seen) const;
};

}  // namespace merlin::state
