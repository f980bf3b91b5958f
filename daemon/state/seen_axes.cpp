#include "daemon/state/seen_axes.h"

namespace merlin::state {

Offset SeenAxes::onSignal(const Offset& o) const {
  // Adding 0.0 turns -0 into 0.
  return {right.x * o.x + down.x * o.y + 0.0, right.y * o.x + down.y * o.y + 0.0};
}

Offset SeenAxes::seen(const Offset& o) const {
  return {right.x * o.x + right.y * o.y + 0.0, down.x * o.x + down.y * o.y + 0.0};
}

std::size_t SeenAxes::cornerOnSignal(std::size_t corner) const {
  const Place place = cornerAt(corner);
  const Offset from_middle = onSignal({2.0 * place.column - 1, 2.0 * place.row - 1});
  return Place{Place::Of::kPin, from_middle.x > 0 ? 1 : 0, from_middle.y > 0 ? 1 : 0}.corner();
}

}  // namespace merlin::state
