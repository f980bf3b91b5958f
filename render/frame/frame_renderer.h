// FrameRenderer: a content's frames, drawn tile by tile: at once at some detail, or finer in
// slices; by one OpenGL context, or by two on threads of their own, with the same pixels.
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

namespace merlin::render {

// Thread-bound to the thread of the contexts' own one.
class FrameRenderer final : public FramePainter {
 public:
  // Attaches the content to the contexts. `plan` and `clock` outlive this. Errors: TilePainter's.
  static Result<std::unique_ptr<FrameRenderer>> make(std::unique_ptr<Content> content,
                                                     const TilePlan& plan,
                                                     std::shared_ptr<const DrawContexts> contexts,
                                                     const Clock& clock);
  ~FrameRenderer() override;
  FrameRenderer(const FrameRenderer&) = delete;
  FrameRenderer& operator=(const FrameRenderer&) = delete;

  // Draws every state that a frame uses once, so that no shader is compiled in a frame.
  void warmUp(const Eigen::Isometry3f& T_eye_content);

  DrawTimes draw(const Request& request) override;
  void beginRefining(const Eigen::Isometry3f& T_eye_content, std::size_t step) override;
  bool refine(Timestamp until) override;
  void setSizeDivisor(int divisor) override { size_divisor_ = divisor; }
  bool sees(const Eigen::Isometry3f& T_eye_content) const override;
  std::span<const FrameStep> steps() const noexcept override { return steps_; }
  std::span<std::uint8_t> pixels() noexcept override { return pixels_; }

  const Content& content() const noexcept { return *content_; }
  const std::shared_ptr<const DrawContexts>& contexts() const noexcept { return contexts_; }

 private:
  FrameRenderer(std::unique_ptr<Content> content, const TilePlan& plan,
                std::shared_ptr<const DrawContexts> contexts, const Clock& clock);
  ContentView viewOf(std::size_t tile, const Eigen::Isometry3f& T_eye_content) const;
  bool isOperators(std::size_t tile) const { return plan_.tiles[tile].kind == TileKind::kOperator; }
  // Some of a frame's tiles, drawn. Times are of all threads together.
  struct TileTimes {
    DrawTimes times;
    Duration operators{};  // of times.drawing: the operator's views
    std::size_t wall_tiles = 0;
    bool gave_way = false;  // an operator's view was left out, for want of time
  };
  void choose(const Eigen::Isometry3f& T_eye_content, std::size_t step,
              std::span<const std::size_t> tiles);
  // work(painter, i) for each context's painter, number i, on its thread.
  void onEach(const std::function<void(TilePainter&, std::size_t)>& work);
  TileTimes drawTiles(const Request& request);
  void drawFrom(TilePainter& painter, const Request& request, TileTimes& drawn);
  void drawOperators(const Eigen::Isometry3f& T_eye_content, std::size_t step, DrawTimes& times);
  void takeSteps();
  void sortLongestFirst();
  Timestamp stepDone(FrameStep::Kind kind, Timestamp began);  // returns now
  std::size_t operatorStep(const Request& request, Duration wall, Duration left) const;
  void learnOperatorShare(Duration wall, Duration operators);

  std::unique_ptr<Content> content_;
  const TilePlan& plan_;
  const Clock& clock_;
  std::shared_ptr<const DrawContexts> contexts_;
  std::unique_ptr<TilePainter> painter_, other_;  // other_: of the other thread; may be none
  std::vector<std::size_t> all_, operators_;      // numbers of tiles
  std::vector<std::size_t> wall_first_;           // all of them, in the order of drawing
  TileQueue queue_;
  std::vector<ContentView> views_;
  std::vector<FrameStep> steps_;                       // of the last draw() or refine()
  std::vector<std::uint8_t> pixels_, refined_pixels_;  // shown; refined, until that is whole
  int size_divisor_ = 1;
  // The operator's views' drawing time as a share of the wall tiles', at the same step; smoothed.
  double operator_share_ = 0.3;
  bool refining_begins_ = false;  // what is refined was not uploaded yet
};

}  // namespace merlin::render
