// SeenAxes: how an output's signal is turned or mirrored before people see it, as a projector that
// hangs upside down or throws from behind needs it. Who stands before the wall says left and right
// as they see it. Pure.
#pragma once

#include <cstddef>

#include "daemon/state/alignment.h"

namespace merlin::state {

struct SeenAxes {
  // What a step to the right, and a step down, on the wall is in the signal: one of x and y of each
  // is 1 or -1.
  Offset right{1, 0}, down{0, 1};

  bool operator==(const SeenAxes&) const = default;
  // An offset on the wall as one in the signal, and back.
  Offset onSignal(const Offset& seen) const;
  Offset seen(const Offset& on_signal) const;
  // The signal's corner that is seen in a corner of the wall; in the order of kCornerNames.
  std::size_t cornerOnSignal(std::size_t seen) const;
};

}  // namespace merlin::state
