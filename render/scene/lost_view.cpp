#include "render/scene/lost_view.h"

namespace merlin::render::scene {

bool LostView::update(bool seen, bool moving, Timestamp now) noexcept {
  if (seen) seen_at_ = now;
  if (seen || moving || !seen_at_ || return_after_ <= Duration::zero()) return false;
  if (now - *seen_at_ < return_after_) return false;
  seen_at_.reset();
  return true;
}

}  // namespace merlin::render::scene
