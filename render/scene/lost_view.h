// LostView: whether a content that nobody sees, and nobody moves, should return to the start. Pure.
#pragma once

#include <optional>

#include "daemon/base/clock.h"

namespace merlin::render {

// Thread-bound.
class LostView {
 public:
  // 0: never.
  explicit LostView(double return_after_s) : return_after_(fromSeconds(return_after_s)) {}

  // Once a frame: whether any of the content was `seen` in a tile of the wall, whether anything is
  // `moving`. True once, where nothing has been seen for return_after_s and nothing moves: the
  // start view is due. Not again before something was seen, since a start view that shows nothing
  // would otherwise return for ever. `now` never falls.
  bool update(bool seen, bool moving, Timestamp now) noexcept;

 private:
  Duration return_after_;
  std::optional<Timestamp> seen_at_;  // last; nothing where it was not since the last return
};

}  // namespace merlin::render
