#include "daemon/wall/tile_painter.h"

#include <algorithm>

namespace merlin::wall {
namespace {

using render::ModelRenderer;

// Triangles of a slice: 1 to 5 ms on llvmpipe; larger ones are no faster (its bins fall out of L2).
constexpr std::size_t kSlice = 10'000;

struct Size {
  int width, height;
};

// Each pixel of `from` as `times` x `times` of them; where `to` is no multiple, the last ones go
// on.
void enlarge(std::span<const std::uint8_t> from, Size size, int times, std::uint8_t* to,
             Size enlarged, int stride_px) {
  for (int y = 0; y < enlarged.height; ++y) {
    const std::uint8_t* row = &from[static_cast<std::size_t>(4) *
                                    static_cast<std::size_t>(std::min(y / times, size.height - 1)) *
                                    static_cast<std::size_t>(size.width)];
    std::uint8_t* out = to + std::ptrdiff_t{4} * y * stride_px;
    for (int x = 0; x < enlarged.width; ++x)
      std::copy_n(row + std::ptrdiff_t{4} * std::min(x / times, size.width - 1), 4, out + 4 * x);
  }
}

}  // namespace

Result<std::unique_ptr<TilePainter>> TilePainter::make(
    const render::GlApi& gl, const render::Dendrogram& model, const render::TilePlan& plan,
    const render::RenderSettings& settings, std::span<const std::uint32_t> full,
    const render::TextureImage* texture, const Clock& clock) {
  std::unique_ptr<TilePainter> painter(new TilePainter(plan, settings, clock));
  auto renderer = ModelRenderer::make(gl, model, full, settings.show, texture);
  if (!renderer) return renderer.error();
  painter->renderer_ = *std::move(renderer);
  painter->tiles_.reserve(plan.tiles.size());
  for (const render::Tile& tile : plan.tiles) {
    auto buffer = render::FrameBuffer::make(gl, tile.width, tile.height);
    if (!buffer) return buffer.error();
    painter->tiles_.push_back(*std::move(buffer));
  }
  return painter;
}

void TilePainter::begin(const FrameContent& content) {
  const Timestamp began = clock_.now();
  refined_ = {};
  if (content.source == ModelRenderer::Source::kCut) renderer_->uploadCut(content.cut);
  renderer_->morph(content.morphs);
  stepDone(shm::StepKind::kUpload, 0, began);
}

Timestamp TilePainter::stepDone(shm::StepKind kind, std::size_t tile, Timestamp began) {
  const Timestamp ended = clock_.now();
  steps_.push_back({kind, static_cast<std::uint16_t>(tile), began, ended});
  return ended;
}

void TilePainter::beginTile(const FrameContent& content, std::size_t tile, int scale) {
  const render::Tile& t = plan_.tiles[tile];
  tiles_[tile].bind();
  renderer_->begin(t.width / scale, t.height / scale, content.cameras[tile], settings_.look);
}

void TilePainter::readTile(std::size_t tile, int scale, std::span<std::uint8_t> frame) {
  const render::Tile& t = plan_.tiles[tile];
  const auto at =
      static_cast<std::size_t>(4) * static_cast<std::size_t>(t.y * plan_.frame_width + t.x);
  if (scale == 1) return tiles_[tile].read(frame.data() + at, plan_.frame_width);
  const int width = t.width / scale, height = t.height / scale;
  small_.resize(std::size_t{4} * static_cast<std::size_t>(width) *
                static_cast<std::size_t>(height));
  tiles_[tile].read(small_.data(), width, width, height);
  enlarge(small_, {width, height}, scale, frame.data() + at, {t.width, t.height},
          plan_.frame_width);
}

// About kSlice triangles of the tile's runs, from where `at` is.
void TilePainter::drawSlice(const FrameContent& content, Progress& at) {
  const auto& runs = content.runs[at.tile];
  for (std::size_t left = kSlice; left > 0 && at.run < runs.size();) {
    const TriangleRun& run = runs[at.run];
    const std::size_t count = std::min(left, run.count - at.triangles);
    renderer_->draw(content.source, run.first + at.triangles, count);
    left -= count;
    at.triangles += count;
    if (at.triangles == run.count) at = {at.tile, at.run + 1, 0};
  }
}

void TilePainter::draw(const FrameContent& content, std::size_t tile, int scale,
                       std::span<std::uint8_t> frame, DrawTimes& times) {
  const Timestamp began = clock_.now();
  beginTile(content, tile, scale);
  const Timestamp cleared = clock_.now();
  for (Progress at{tile}; at.run < content.runs[tile].size();) {
    drawSlice(content, at);
    renderer_->flush();
  }
  const Timestamp drawn = stepDone(shm::StepKind::kDraw, tile, began);
  readTile(tile, scale, frame);
  const Timestamp read = stepDone(shm::StepKind::kReadBack, tile, drawn);
  times.drawing += drawn - cleared;
  times.fixed += (cleared - began) + (read - drawn);
}

void TilePainter::refine(const FrameContent& content, TileQueue& queue,
                         std::span<std::uint8_t> frame, Timestamp until) {
  bool idle = true;
  for (Timestamp now = clock_.now(); now + slice_time_ * 3 / 2 < until;) {
    idle = false;
    if (refined_.tile == TileQueue::kNone) {
      const std::size_t tile = queue.take();
      if (tile == TileQueue::kNone) return;
      refined_ = {tile};
      beginTile(content, tile, 1);
    }
    drawSlice(content, refined_);
    renderer_->finish();
    if (refined_.run == content.runs[refined_.tile].size()) {
      readTile(refined_.tile, 1, frame);
      refined_ = {};
      queue.done();
    }
    const Timestamp then = std::exchange(now, clock_.now());
    slice_time_ = std::max<Duration>(now - then, slice_time_ * 9 / 10);
  }
  // Where slices take longer than a period has, the figure fades until one is tried again.
  if (idle) slice_time_ = slice_time_ * 9 / 10;
}

}  // namespace merlin::wall
