// TilePainter: one OpenGL context's part in drawing a picture: the model's nodes and frame buffers
// for all tiles, of which it draws those that nobody else has taken.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/wall/painter.h"
#include "render/gl/frame_buffer.h"
#include "render/gl/model_renderer.h"
#include "render/tiles/tile_plan.h"

namespace merlin::wall {

// Triangles of one draw call, in the order of their source.
struct TriangleRun {
  std::size_t first = 0, count = 0;
};

// What all tiles of a frame show; the same for all who draw it, who only read it.
struct FrameContent {
  render::ModelRenderer::Source source = render::ModelRenderer::Source::kCut;
  std::span<const std::uint32_t> cut;          // of kCut: node numbers, 3 a triangle
  std::span<const render::Morph> morphs;       // of its vertices
  std::vector<render::Camera> cameras;         // of each tile of the plan
  std::vector<std::vector<TriangleRun>> runs;  // the same: what it sees
};

// Tiles that are handed out one after another. Thread-safe.
class TileQueue {
 public:
  // Numbers of the plan's tiles.
  void begin(std::span<const std::size_t> tiles) {
    tiles_.assign(tiles.begin(), tiles.end());
    next_ = done_ = 0;
  }
  static constexpr std::size_t kNone = ~std::size_t{0};
  std::size_t take() noexcept {
    const std::size_t i = next_.fetch_add(1);
    return i < tiles_.size() ? tiles_[i] : kNone;
  }
  void done() noexcept { done_.fetch_add(1); }
  bool allDone() const noexcept { return done_.load() == tiles_.size(); }

 private:
  std::vector<std::size_t> tiles_;
  std::atomic<std::size_t> next_{0}, done_{0};
};

// Thread-bound to its context, which outlives it, as plan and clock do.
class TilePainter {
 public:
  // Errors: kUnsupported, kInvalidArgument, as ModelRenderer and FrameBuffer say.
  static Result<std::unique_ptr<TilePainter>> make(
      const render::GlApi& gl, const render::Dendrogram& model, const render::TilePlan& plan,
      const render::RenderSettings& settings, std::span<const std::uint32_t> full,
      const render::TextureImage* texture, const Clock& clock);

  // Before tiles of it are drawn. Forgets what was refined.
  void begin(const FrameContent& content);

  // Draws the tile and copies it to where it belongs in `frame`. `scale`: in so many pixels' size,
  // enlarged. Adds to `times`.
  void draw(const FrameContent& content, std::size_t tile, int scale, std::span<std::uint8_t> frame,
            DrawTimes& times);

  // Draws slices of tiles of the queue until about `until`; goes on where it was.
  void refine(const FrameContent& content, TileQueue& queue, std::span<std::uint8_t> frame,
              Timestamp until);
  // What it takes refine() to do anything: a slice takes about 2/3 of that.
  Duration sliceTime() const noexcept { return slice_time_; }

  // Of begin() and draw(), until they are cleared.
  std::span<const PaintStep> steps() const noexcept { return steps_; }
  void clearSteps() noexcept { steps_.clear(); }

 private:
  TilePainter(const render::TilePlan& plan, const render::RenderSettings& settings,
              const Clock& clock)
      : plan_(plan), settings_(settings), clock_(clock) {}
  // How far a tile is drawn.
  struct Progress {
    std::size_t tile = TileQueue::kNone, run = 0, triangles = 0;
  };
  void beginTile(const FrameContent& content, std::size_t tile, int scale);
  void drawSlice(const FrameContent& content, Progress& at);
  void readTile(std::size_t tile, int scale, std::span<std::uint8_t> frame);
  Timestamp stepDone(shm::StepKind kind, std::size_t tile, Timestamp began);  // returns now

  const render::TilePlan& plan_;
  render::RenderSettings settings_;
  const Clock& clock_;
  std::unique_ptr<render::ModelRenderer> renderer_;
  std::vector<render::FrameBuffer> tiles_;
  std::vector<std::uint8_t> small_;  // of a tile that is enlarged
  std::vector<PaintStep> steps_;
  Progress refined_;
  Duration slice_time_ = std::chrono::milliseconds(4);  // of the last slices, the worst, fading
};

}  // namespace merlin::wall
