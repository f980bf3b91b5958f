// FrameRenderer: draws a content's frames tile by tile: whole frames at a given detail, or finer
// ones in slices. It uses one OpenGL context, or two on separate threads; the pixels are the same.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "render/content/content.h"
#include "render/frame/draw_contexts.h"
#include "render/frame/frame_painter.h"
#include "render/frame/tile_painter.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::frame {

// Thread-bound to the thread of `contexts->own`.
class FrameRenderer final : public FramePainter {
 public:
  // Attaches the content to the contexts. `plan` and `clock` must outlive this. Errors: those of
  // TilePainter::make().
  static Result<std::unique_ptr<FrameRenderer>> make(std::unique_ptr<content::Content> content,
                                                     const tiles::TilePlan& plan,
                                                     std::shared_ptr<const DrawContexts> contexts,
                                                     const Clock& clock);
  ~FrameRenderer() override;
  FrameRenderer(const FrameRenderer&) = delete;
  FrameRenderer& operator=(const FrameRenderer&) = delete;

  // Draws once in each way in which frames are drawn, so that no shader is compiled later during a
  // frame.
  void warmUp(const Eigen::Isometry3f& T_eye_content);

  DrawTimes draw(const Request& request) override;
  void beginRefining(const Eigen::Isometry3f& T_eye_content, std::size_t step) override;
  bool refine(Timestamp until) override;
  void setSizeDivisor(int divisor) override { size_divisor_ = divisor; }
  bool sees(const Eigen::Isometry3f& T_eye_content) const override;
  content::Pending pending() const noexcept override { return content_->pending(); }
  std::span<const FrameStep> steps() const noexcept override { return steps_; }
  std::span<std::uint8_t> pixels() noexcept override { return pixels_; }

  const content::Content& content() const noexcept { return *content_; }
  const std::shared_ptr<const DrawContexts>& contexts() const noexcept { return contexts_; }

 private:
  FrameRenderer(std::unique_ptr<content::Content> content, const tiles::TilePlan& plan,
                std::shared_ptr<const DrawContexts> contexts, const Clock& clock);
  content::ContentView viewOf(std::size_t tile, const Eigen::Isometry3f& T_eye_content) const;
  bool isOperators(std::size_t tile) const {
    return plan_.tiles[tile].kind == tiles::TileKind::kOperator;
  }
  // The times that drawing some of a frame's tiles took; sums over all threads.
  struct TileTimes {
    DrawTimes times;
    Duration operators{};  // part of times.drawing: the operator's views
    std::size_t wall_tiles = 0;
    bool gave_way = false;  // an operator's view was skipped, for lack of time
  };
  void choose(const Eigen::Isometry3f& T_eye_content, std::size_t step,
              std::span<const std::size_t> tiles);
  // Calls work(painter, i) for the painter of each context i, on that context's thread.
  void onEach(const std::function<void(TilePainter&, std::size_t)>& work);
  TileTimes drawTiles(const Request& request);
  void drawFrom(TilePainter& painter, const Request& request, TileTimes& drawn);
  void drawOperators(const Eigen::Isometry3f& T_eye_content, std::size_t step, DrawTimes& times);
  void takeSteps();
  void sortLongestFirst();
  Timestamp stepDone(FrameStep::Kind kind, Timestamp began);  // returns now
  std::size_t operatorStep(const Request& request, Duration wall, Duration left) const;
  void learnOperatorShare(Duration wall, Duration operators);

  std::unique_ptr<content::Content> content_;
  const tiles::TilePlan& plan_;
  const Clock& clock_;
  std::shared_ptr<const DrawContexts> contexts_;
  std::unique_ptr<TilePainter> painter_, other_;  // other_: on the other thread; may be null
  std::vector<std::size_t> all_, operators_;      // indices of tiles
  std::vector<std::size_t> wall_first_;           // indices of all tiles, in the order of drawing
  TileQueue queue_;
  std::vector<content::ContentView> views_;
  std::vector<FrameStep> steps_;                       // of the last draw() or refine()
  std::vector<std::uint8_t> pixels_, refined_pixels_;  // shown; being refined
  int size_divisor_ = 1;
  // Ratio of the operator's views' drawing time to the wall tiles', at the same step; low-pass
  // filtered.
  double operator_share_ = 0.3;
  bool refining_begins_ = false;  // beginRefining() was called and nothing was uploaded yet
};

}  // namespace merlin::render::frame
