// TilePainter: draws tiles with one OpenGL context: it has render targets for all tiles and the
// content's renderer in that context. Several painters share a frame's tiles by a queue.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "render/content/content.h"
#include "render/frame/frame_painter.h"
#include "render/frame/tile_queue.h"
#include "render/gl/draw_timer.h"
#include "render/gl/gl_context.h"
#include "render/gl/read_back.h"
#include "render/gl/render_target.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::frame {

// Thread-bound to its context. The context, content, plan and clock must outlive it.
class TilePainter {
 public:
  // `asynchronous`: pixels are read back through pixel buffers, while other tiles are drawn.
  // Errors: kUnsupported, kInvalidArgument: those of Content::attach() and RenderTarget::make().
  static Result<std::unique_ptr<TilePainter>> make(const gl::GlContext& context,
                                                   const content::Content& content,
                                                   const tiles::TilePlan& plan, const Clock& clock,
                                                   bool asynchronous);

  // Begins a frame, after the content has chosen its detail: uploads what was chosen. Abandons a
  // tile that is being refined.
  void begin();

  // Draws the tile at 1/divisor of its width and height and copies it, upscaled, to its position in
  // `canvas`; asynchronously, finish() does the latter. Adds its times to `times`.
  void draw(std::size_t tile, int divisor, std::span<std::uint8_t> canvas, DrawTimes& times);

  // Waits until the GPU has finished drawing the tiles given to it so far, and adds the time to
  // `times`. Does nothing unless asynchronous.
  void awaitDrawn(DrawTimes& times);
  // Waits for the pixels of all tiles drawn since the last finish() and copies them to their
  // positions in `canvas`. Does nothing unless asynchronous.
  void finish(std::span<std::uint8_t> canvas, DrawTimes& times);

  // Draws slices of the queue's tiles until about `until`; continues where the last call stopped.
  void refine(TileQueue& queue, std::span<std::uint8_t> canvas, Timestamp until);
  // Peak of the slice times, decaying by 10 % per slice. refine() draws nothing when less than 1.5
  // times this is left.
  Duration sliceTime() const noexcept { return slice_time_; }

  // Steps recorded by begin() and draw() since the last clearSteps().
  std::span<const FrameStep> steps() const noexcept { return steps_; }
  void clearSteps() noexcept { steps_.clear(); }

 private:
  // A tile whose drawing was given to the GPU and whose pixels are not in the canvas yet.
  struct Unread {
    std::size_t tile;
    int divisor;
    Duration given{};      // time that it took to submit the tile to the GPU
    bool awaited = false;  // awaitDrawn() has waited for it
  };

  TilePainter(const gl::GlContext& context, const tiles::TilePlan& plan, const Clock& clock)
      : gl_(context.gl()), software_(context.info().software), plan_(plan), clock_(clock) {}
  bool isAsynchronous() const { return !read_backs_.empty(); }
  void beginTile(std::size_t tile, int divisor);
  void drawTile(std::size_t tile);
  void startReading(std::size_t tile, int divisor);
  void readTile(std::size_t tile, int divisor, std::span<std::uint8_t> canvas);
  Timestamp stepDone(FrameStep::Kind kind, std::size_t tile, Timestamp began);  // returns now

  const gl::GlApi& gl_;
  const bool software_;
  const tiles::TilePlan& plan_;
  const Clock& clock_;
  std::unique_ptr<content::ContentRenderer> renderer_;
  std::vector<gl::RenderTarget> targets_;  // by tile
  std::vector<gl::ReadBack> read_backs_;   // by tile; empty unless asynchronous, like the timers
  std::vector<gl::DrawTimer> timers_;
  std::vector<Unread> unread_;
  std::vector<std::uint8_t> small_;  // a tile before it is upscaled
  std::vector<FrameStep> steps_;
  std::size_t refined_tile_ = TileQueue::kNone;
  content::DrawProgress refined_;
  Duration slice_time_ = std::chrono::milliseconds(4);
};

}  // namespace merlin::render::frame
