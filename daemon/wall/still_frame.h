// StillFrame: refines the frame of a scene in which nothing moves, in several steps. Each finer
// frame is faded in.
//
// The first finer frame has so little detail that it can be shown soon; each further one has eight
// times as much detail, and the last one has full detail. Drawing all of them takes less than 1.5
// times as long as drawing full detail alone.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "daemon/base/clock.h"
#include "daemon/wall/content_turns.h"
#include "render/frame/fade.h"
#include "render/governor/governor.h"

namespace merlin::wall {

// Thread-bound to the wall's thread.
class StillFrame {
 public:
  // `fade_frames`: number of frames in which a finer frame is faded in, at least 1. `governor` must
  // outlive this object.
  StillFrame(const render::governor::Governor& governor, int fade_frames)
      : governor_(governor), fade_frames_(fade_frames) {}

  // Starts refinement. To be called when motion has ended, at `now`. `shown`: the canvas that the
  // wall shows.
  void begin(Timestamp now, std::span<const std::uint8_t> shown);
  // Ends refinement and fade. To be called before a moving frame is drawn.
  void stop() noexcept;
  // Starts refinement again with a frame that can be shown soon. To be called when another content
  // replaces the one shown.
  void restart() noexcept;

  // Draws slices of a frame that is finer than `step`, until about `until`. When the frame is
  // complete, begins the fade to it and returns its step; before that, returns nothing.
  // `size_divisor`: divisor of the tiles' size in moving frames (Pace::sizeDivisor()).
  std::optional<std::size_t> refine(const ContentTurns& turns,
                                    const Eigen::Isometry3f& T_eye_content, std::size_t step,
                                    int size_divisor, Timestamp until);

  bool isRefining() const noexcept { return refining_.has_value(); }
  bool isFading() const noexcept { return fade_.isOn(); }
  // Returns the next canvas of the fade to `target`. REQUIRES: isFading().
  std::span<std::uint8_t> nextFading(std::span<const std::uint8_t> target) {
    return fade_.next(target);
  }

  // To be called after a frame of the fade was shown at `now`. Returns the times since motion
  // ended: to_first_s, for the first frame of the fade after begin() or restart() only, and
  // to_full_s if this frame has full detail (`full_detail`).
  struct Times {
    std::optional<float> to_first_s, to_full_s;
  };
  Times shown(Timestamp now, bool full_detail) noexcept;

 private:
  std::size_t finerStep(const render::content::DetailAxis& detail, std::size_t step,
                        int size_divisor) const;

  const render::governor::Governor& governor_;
  int fade_frames_;
  render::frame::Fade fade_;             // fade to the last refined frame
  std::optional<std::size_t> refining_;  // detail step of the frame that is being refined
  bool first_ = false;                   // the next finer frame is the first one since motion ended
  Timestamp since_{};
};

}  // namespace merlin::wall
