#include "render/frame/tile_painter.h"

#include <algorithm>
#include <utility>

namespace merlin::render::frame {
namespace {

struct Size {
  int width, height;
};

// Upscales by repeating each pixel of `from` times x times times. If the target's size is not a
// multiple of `times`, the last row and column fill the remainder.
void upscale(std::span<const std::uint8_t> from, Size size, int times, std::uint8_t* to,
             Size upscaled, int stride_px) {
  for (int y = 0; y < upscaled.height; ++y) {
    const std::uint8_t* row = &from[static_cast<std::size_t>(4) *
                                    static_cast<std::size_t>(std::min(y / times, size.height - 1)) *
                                    static_cast<std::size_t>(size.width)];
    std::uint8_t* out = to + std::ptrdiff_t{4} * y * stride_px;
    for (int x = 0; x < upscaled.width; ++x)
      std::copy_n(row + std::ptrdiff_t{4} * std::min(x / times, size.width - 1), 4, out + 4 * x);
  }
}

}  // namespace

Result<std::unique_ptr<TilePainter>> TilePainter::make(const gl::GlContext& context,
                                                       const content::Content& content,
                                                       const tiles::TilePlan& plan,
                                                       const Clock& clock, bool asynchronous) {
  const gl::GlApi& gl = context.gl();
  std::unique_ptr<TilePainter> painter(new TilePainter(context, plan, clock));
  auto renderer = content.attach(gl);
  if (!renderer) return renderer.error();
  painter->renderer_ = *std::move(renderer);
  painter->targets_.reserve(plan.tiles.size());
  for (const tiles::Tile& tile : plan.tiles) {
    auto target = gl::RenderTarget::make(gl, tile.width, tile.height);
    if (!target) return target.error();
    painter->targets_.push_back(*std::move(target));
    if (!asynchronous) continue;
    painter->read_backs_.emplace_back(gl);
    painter->timers_.emplace_back(gl);
  }
  return painter;
}

void TilePainter::begin() {
  const Timestamp began = clock_.now();
  refined_tile_ = TileQueue::kNone;
  unread_.clear();
  renderer_->beginFrame();
  stepDone(FrameStep::Kind::kUpload, 0, began);
}

Timestamp TilePainter::stepDone(FrameStep::Kind kind, std::size_t tile, Timestamp began) {
  const Timestamp ended = clock_.now();
  steps_.push_back({kind, static_cast<std::uint16_t>(tile), began, ended});
  return ended;
}

void TilePainter::beginTile(std::size_t tile, int divisor) {
  const tiles::Tile& t = plan_.tiles[tile];
  targets_[tile].bind();
  renderer_->beginView(tile, t.width / divisor, t.height / divisor);
}

void TilePainter::readTile(std::size_t tile, int divisor, std::span<std::uint8_t> canvas) {
  const tiles::Tile& t = plan_.tiles[tile];
  const auto at =
      static_cast<std::size_t>(4) * static_cast<std::size_t>(t.y * plan_.frame_width + t.x);
  const int width = t.width / divisor, height = t.height / divisor;
  std::uint8_t* to = canvas.data() + at;
  int stride_px = plan_.frame_width;
  if (divisor > 1) {
    small_.resize(std::size_t{4} * static_cast<std::size_t>(width) *
                  static_cast<std::size_t>(height));
    to = small_.data();
    stride_px = width;
  }
  if (isAsynchronous())
    read_backs_[tile].finish(to, stride_px);
  else
    targets_[tile].read(to, stride_px, width, height);
  if (divisor > 1) {
    upscale(small_, {width, height}, divisor, canvas.data() + at, {t.width, t.height},
            plan_.frame_width);
  }
}

void TilePainter::startReading(std::size_t tile, int divisor) {
  const tiles::Tile& t = plan_.tiles[tile];
  read_backs_[tile].start(targets_[tile], t.width / divisor, t.height / divisor);
  gl_.Flush();
}

// Flushes after each slice, so that llvmpipe draws it then: this is faster than drawing a whole
// tile at once.
void TilePainter::drawTile(std::size_t tile) {
  content::DrawProgress progress;
  if (isAsynchronous()) timers_[tile].begin();
  for (bool whole = false; !whole;) {
    whole = renderer_->drawSlice(tile, progress);
    if (software_) gl_.Flush();
  }
  if (isAsynchronous())
    timers_[tile].end();
  else if (!software_)
    gl_.Finish();  // so that the time for drawing is not counted as read-back
}

void TilePainter::draw(std::size_t tile, int divisor, std::span<std::uint8_t> canvas,
                       DrawTimes& times) {
  const Timestamp began = clock_.now();
  beginTile(tile, divisor);
  const Timestamp cleared = clock_.now();
  drawTile(tile);
  const Timestamp drawn = stepDone(FrameStep::Kind::kDraw, tile, began);
  if (isAsynchronous()) {
    startReading(tile, divisor);
    unread_.push_back({tile, divisor, drawn - cleared});
  } else {
    readTile(tile, divisor, canvas);
  }
  const Timestamp read = stepDone(FrameStep::Kind::kReadBack, tile, drawn);
  times.drawing += drawn - cleared;
  times.fixed += (cleared - began) + (read - drawn);
}

void TilePainter::awaitDrawn(DrawTimes& times) {
  if (unread_.empty()) return;
  const Timestamp began = clock_.now();
  for (Unread& unread : unread_) {
    if (!std::exchange(unread.awaited, true)) timers_[unread.tile].elapsed();
  }
  times.drawing += clock_.now() - began;
}

// The tiles' pixels are copied while the GPU draws the tiles after them, so the elapsed time is
// split with the drawing time that the GPU reports.
void TilePainter::finish(std::span<std::uint8_t> canvas, DrawTimes& times) {
  if (unread_.empty()) return;
  const Timestamp began = clock_.now();
  Duration drawing{};
  for (const Unread& unread : unread_) {
    const Timestamp from = clock_.now();
    readTile(unread.tile, unread.divisor, canvas);
    stepDone(FrameStep::Kind::kReadBack, unread.tile, from);
    if (!unread.awaited) drawing += timers_[unread.tile].elapsed() - unread.given;
  }
  unread_.clear();
  const Duration elapsed = clock_.now() - began;
  drawing = std::clamp(drawing, Duration::zero(), elapsed);
  times.drawing += drawing;
  times.fixed += elapsed - drawing;
}

void TilePainter::refine(TileQueue& queue, std::span<std::uint8_t> canvas, Timestamp until) {
  bool idle = true;
  for (Timestamp now = clock_.now(); now + slice_time_ * 3 / 2 < until;) {
    idle = false;
    if (refined_tile_ == TileQueue::kNone) {
      refined_tile_ = queue.take();
      if (refined_tile_ == TileQueue::kNone) return;
      refined_ = {};
      beginTile(refined_tile_, 1);
    }
    const bool whole = renderer_->drawSlice(refined_tile_, refined_);
    gl_.Finish();
    if (whole) {
      if (isAsynchronous()) startReading(refined_tile_, 1);
      readTile(refined_tile_, 1, canvas);
      refined_tile_ = TileQueue::kNone;
      queue.done();
    }
    const Timestamp then = std::exchange(now, clock_.now());
    slice_time_ = std::max<Duration>(now - then, slice_time_ * 9 / 10);
  }
  // If the time was too short even for one slice, the estimate decays until a slice is tried again.
  if (idle) slice_time_ = slice_time_ * 9 / 10;
}

}  // namespace merlin::render::frame
