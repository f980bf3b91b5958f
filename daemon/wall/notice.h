// Notice: a sentence that a client has the wall show for a few seconds, such as how far the import
// of a file is: over the picture, and in shared memory.
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
  // All must outlive this object.
  Notice(const render::tiles::TilePlan& plan, shm::SeqSlot<shm::WallNotice>& slot,
         const Clock& clock)
      : slot_(slot), clock_(clock), overlay_(plan, clock) {}

  // Shows the sentence for kShown, in place of the one before; "off" ends it. Thread-safe. Errors:
  // kInvalidArgument (not 1 to kMostBytes bytes of text), those of NoticeOverlay::show().
  Result<Ok> show(const std::string& text);

  // Shows the sentence for as long as this is called ten times a second, while no client shows
  // another. Thread-safe. Errors: those of show().
  Result<Ok> stand(const std::string& text, Timestamp now);

  // Writes shared memory when the sentence changes; to be called ten times a second, on one thread.
  void tend(Timestamp now);

  // For the wall's thread.
  render::frame::Overlay& overlay() noexcept { return overlay_; }

  static constexpr Duration kShown = std::chrono::seconds(5);
  static constexpr std::size_t kMostBytes = sizeof(shm::WallNotice::text) - 1;

 private:
  shm::SeqSlot<shm::WallNotice>& slot_;
  const Clock& clock_;
  render::text::NoticeOverlay overlay_;
  std::string published_;  // of tend()'s thread
  std::mutex mutex_;
  // Guarded by mutex_.
  std::string text_;
  Timestamp until_{};
};

}  // namespace merlin::wall
