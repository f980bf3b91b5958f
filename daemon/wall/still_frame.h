// StillFrame: refines the frame of a still scene step by step; each finer frame is faded in.
//
// The first finer frame is small enough to be shown soon; each further one has eight times as much
// detail, and the last one full detail. All of them together take less than 1.5 times as long as
// full detail alone.
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

  // To be called when motion has ended, at `now`; `shown` is the canvas that the wall shows.
  void begin(Timestamp now, std::span<const std::uint8_t> shown);
  // To be called before a moving frame: abandons refinement and fade.
  void stop() noexcept;
  // To be called when another content replaces the one shown: refinement restarts with a frame that
  // can be shown soon.
  void restart() noexcept;

  // Draws slices of a frame that is finer than `step`, until about `until`. When the frame is
  // complete, returns its step, and the fade to it begins; before that, returns nullopt.
  // `size_divisor`: that of moving frames.
  std::optional<std::size_t> refine(const ContentTurns& turns,
                                    const Eigen::Isometry3f& T_eye_content, std::size_t step,
                                    int size_divisor, Timestamp until);

  bool isRefining() const noexcept { return refining_.has_value(); }
  bool isFading() const noexcept { return fade_.isOn(); }
  // Returns the next canvas of the fade to `target`. REQUIRES: isFading().
  std::span<std::uint8_t> nextFading(std::span<const std::uint8_t> target) {
    return fade_.next(target);
  }

  // To be called after a frame of the fade was shown at `now`. Returns times since motion ended
  // [s]: to the first finer frame (only once after begin() or restart()), and to full detail, if
  // `full_detail`.
  struct Times {
    std::optional<float> to_first_s, to_full_s;
  };
  Times shown(Timestamp now, bool full_detail) noexcept;

 private:
  std::size_t finerStep(const render::content::DetailAxis& detail, std::size_t step,
                        int size_divisor) const;

  const render::governor::Governor& governor_;
  int fade_frames_;
  render::frame::Fade fade_;             // fades to the last refined frame
  std::optional<std::size_t> refining_;  // detail step of the frame that is being refined
  bool first_ = false;                   // the next finer frame is the first since motion ended
  Timestamp since_{};
};

}  // namespace merlin::wall
