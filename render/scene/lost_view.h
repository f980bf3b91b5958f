// LostView: decides when the start view returns, because no tile has shown the content for some
// time and nobody moves it. Pure.
#pragma once

#include <optional>

#include "daemon/base/clock.h"

namespace merlin::render::scene {

// Thread-bound.
class LostView {
 public:
  // `return_after_s`: time without the content in any tile; 0: the view never returns.
  explicit LostView(double return_after_s) : return_after_(fromSeconds(return_after_s)) {}

  // To be called once a frame. `seen`: a tile of the wall shows a part of the content; `moving`:
  // something moves. Returns true once, to tell that the start view should be shown, if nothing was
  // seen for return_after_s and nothing moves. It returns true again only after something was seen,
  // since a start view that shows nothing would otherwise be restored repeatedly. REQUIRES: `now`
  // never decreases.
  bool update(bool seen, bool moving, Timestamp now) noexcept;

  // Replaces the time after which the start view returns; the time of the last sighting is kept.
  void setReturnAfter(double return_after_s) noexcept {
    return_after_ = fromSeconds(return_after_s);
  }

 private:
  Duration return_after_;
  // Time of the last sighting; nullopt if there was none since the last return.
  std::optional<Timestamp> seen_at_;
};

}  // namespace merlin::render::scene
