// TilePainter: one OpenGL context's part in drawing a frame: render targets for all tiles and the
// content's renderer there. It draws those tiles that no other context has taken.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "render/content/content.h"
#include "render/frame/frame_painter.h"
#include "render/frame/tile_queue.h"
#include "render/gl/render_target.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render {

// Thread-bound to its context, which outlives it, as content, plan and clock do.
class TilePainter {
 public:
  // Errors: kUnsupported, kInvalidArgument, as Content::attach() and RenderTarget say.
  static Result<std::unique_ptr<TilePainter>> make(const GlApi& gl, const Content& content,
                                                   const TilePlan& plan, const Clock& clock);

  // Once a frame, after the content has chosen what it shows. Abandons what was being refined.
  void begin();

  // Draws the tile at 1/divisor of its size and copies it, upscaled, to its place in `canvas`.
  // Adds to `times`.
  void draw(std::size_t tile, int divisor, std::span<std::uint8_t> canvas, DrawTimes& times);

  // Draws slices of the queue's tiles until about `until`, and goes on where it was the last time.
  void refine(TileQueue& queue, std::span<std::uint8_t> canvas, Timestamp until);
  // The worst time of the recent slices. refine() draws nothing when less than 1.5 times this is
  // left.
  Duration sliceTime() const noexcept { return slice_time_; }

  // Steps of begin() and draw(), until they are cleared.
  std::span<const FrameStep> steps() const noexcept { return steps_; }
  void clearSteps() noexcept { steps_.clear(); }

 private:
  TilePainter(const GlApi& gl, const TilePlan& plan, const Clock& clock)
      : gl_(gl), plan_(plan), clock_(clock) {}
  void beginTile(std::size_t tile, int divisor);
  void readTile(std::size_t tile, int divisor, std::span<std::uint8_t> canvas);
  Timestamp stepDone(FrameStep::Kind kind, std::size_t tile, Timestamp began);  // returns now

  const GlApi& gl_;
  const TilePlan& plan_;
  const Clock& clock_;
  std::unique_ptr<ContentRenderer> renderer_;
  std::vector<RenderTarget> targets_;  // by tile
  std::vector<std::uint8_t> small_;    // a tile before it is upscaled
  std::vector<FrameStep> steps_;
  std::size_t refined_tile_ = TileQueue::kNone;
  DrawProgress refined_;
  Duration slice_time_ = std::chrono::milliseconds(4);
};

}  // namespace merlin::render
