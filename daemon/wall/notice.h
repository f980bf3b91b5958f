// Notice: shows a client's sentence, such as the progress of an import, for a few seconds over the
// picture, and publishes it in shared memory.
#pragma once

#include <mutex>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/shm/layout.h"
#include "render/text/notice_overlay.h"

namespace merlin::wall {

class Notice {
 public:
  // The arguments must outlive this object.
  Notice(const render::tiles::TilePlan& plan, shm::SeqSlot<shm::WallNotice>& slot,
         const Clock& clock)
      : slot_(slot), clock_(clock), overlay_(plan, clock) {}

  // Shows the sentence for kShown, in place of the one before; the text "off" ends the present
  // sentence. Thread-safe. Errors: kInvalidArgument (`text` is not 1 to kMostBytes bytes of valid
  // text), those of NoticeOverlay::show().
  Result<Ok> show(const std::string& text);

  // Keeps showing the sentence as long as this is called ten times a second. Does nothing while
  // another sentence is shown. Thread-safe. Errors: those of show().
  Result<Ok> stand(const std::string& text, Timestamp now);

  // Publishes the sentence in shared memory when it changes or ends. To be called ten times a
  // second, always on the same thread.
  void tend(Timestamp now);

  // Returns the overlay that draws the sentence. For the wall's thread.
  render::frame::Overlay& overlay() noexcept { return overlay_; }

  static constexpr Duration kShown = std::chrono::seconds(5);
  static constexpr std::size_t kMostBytes = sizeof(shm::WallNotice::text) - 1;

 private:
  shm::SeqSlot<shm::WallNotice>& slot_;
  const Clock& clock_;
  render::text::NoticeOverlay overlay_;
  std::string published_;  // last published sentence; used by tend() only
  std::mutex mutex_;
  // The sentence and the time at which it ends. Guarded by mutex_.
  std::string text_;
  Timestamp until_{};
};

}  // namespace merlin::wall
