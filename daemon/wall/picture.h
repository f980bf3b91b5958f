// Picture: the frame that the wall shows, drawn from a model tile by tile: a cut at once, or full
// detail in slices; by one OpenGL context, or by two on threads of their own, with the same pixels.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/wall/draw_thread.h"
#include "daemon/wall/painter.h"
#include "daemon/wall/tile_painter.h"
#include "render/gl/gl_context.h"
#include "render/lod/clusters.h"
#include "render/lod/dendrogram.h"
#include "render/lod/view_cut.h"
#include "render/tiles/tile_plan.h"

namespace merlin::wall {

// Where pictures are drawn: the wall thread's own context and, where there is one, another
// thread's.
struct DrawContexts {
  std::unique_ptr<render::GlContext> own;
  std::unique_ptr<DrawThread> other;

  // Current on this thread. `settings`: which, and how many. Errors: kUnsupported (no GL of that
  // kind, or not enough of it).
  static Result<std::shared_ptr<DrawContexts>> make(const render::RenderSettings& settings);

  std::string renderer() const;  // for a person
};

// Thread-bound: uploaded, used and destroyed on the wall's thread (its GL context is current
// there).
class Picture final : public Painter {
 public:
  // `radius_m`: the model is scaled to a bounding sphere of this radius about its box's centre.
  // The model is borrowed. `contexts`: another picture's, of this thread, to be drawn in as well;
  // none: some of its own. Errors: DrawContexts', TilePainter's, kMalformed (a texture that cannot
  // be read).
  static Result<std::unique_ptr<Picture>> make(
      const render::Dendrogram& model, const render::TilePlan& plan,
      const render::RenderSettings& settings, double radius_m, const Clock& clock,
      std::shared_ptr<const DrawContexts> contexts = nullptr);
  // make() in two steps: prepare(), on any thread, does what needs no OpenGL, which is most of it;
  // upload(), once, on the wall's thread, the rest. Errors: as make()'s.
  static Result<std::unique_ptr<Picture>> prepare(const render::Dendrogram& model,
                                                  const render::TilePlan& plan,
                                                  const render::RenderSettings& settings,
                                                  double radius_m, const Clock& clock);
  Result<Ok> upload(std::shared_ptr<const DrawContexts> contexts);
  ~Picture() override;

  // Draws every state that a frame uses once, so that no shader is compiled in a frame.
  void warmUp(const Eigen::Isometry3f& T_eye_model);

  DrawTimes draw(const Eigen::Isometry3f& T_eye_model, std::size_t level, Timestamp until) override;
  void beginRefining(const Eigen::Isometry3f& T_eye_model) override;
  bool beginRefiningTo(const Eigen::Isometry3f& T_eye_model, std::size_t level) override;
  bool refine(Timestamp until) override;
  void setScale(int divisor) override { scale_ = divisor; }
  bool sees(const Eigen::Isometry3f& T_eye_model) const override;
  std::span<const PaintStep> steps() const noexcept override { return steps_; }
  std::span<std::uint8_t> pixels() noexcept override { return pixels_; }

  const std::shared_ptr<const DrawContexts>& contexts() const noexcept { return contexts_; }

 private:
  Picture(const render::Dendrogram& model, const render::TilePlan& plan,
          const render::RenderSettings& settings, double radius_m, const Clock& clock);
  render::Camera cameraOf(std::size_t tile, const Eigen::Isometry3f& T_eye_model) const;
  bool isOperators(std::size_t tile) const {
    return plan_.tiles[tile].kind == render::TileKind::kOperator;
  }
  // Tiles of a frame, or some of them, as they are drawn: times are of all threads together.
  struct Drawn {
    DrawTimes times;
    Duration operators{};  // of times.drawing
    std::size_t wall_tiles = 0;
    bool gave_way = false;  // an operator's view was left out, for want of time
  };
  // What is drawn at `level`, for these views; view i is of tile `tiles[i]`.
  void chooseCut(const Eigen::Isometry3f& T_eye_model, std::size_t level,
                 std::span<const std::size_t> tiles);
  std::size_t cutTo(std::size_t level, bool uneven);
  void chooseRuns(std::size_t view, std::vector<TriangleRun>& runs) const;
  // work(painter, i) for each context's painter, number i, on its thread.
  void onEach(const std::function<void(TilePainter&, std::size_t)>& work);
  Drawn drawTiles(std::size_t level, Timestamp until);
  void drawFrom(TilePainter& painter, std::size_t level, Timestamp until, Drawn& drawn);
  void drawOperators(const Eigen::Isometry3f& T_eye_model, std::size_t level, DrawTimes& times);
  void takeSteps();
  void longestFirst();
  Timestamp stepDone(shm::StepKind kind, Timestamp began);  // returns now
  std::size_t levelThatFits(std::size_t level, Duration wall, Duration left) const;
  void learnOperatorShare(Duration wall, Duration operators);

  const render::Dendrogram& model_;
  render::TilePlan plan_;
  render::RenderSettings settings_;
  float radius_m_;
  Eigen::Matrix4f metres_from_model_;  // scale and centring
  Eigen::Matrix4f T_metres_box_;       // the model's box, of the cube -1..1
  const Clock& clock_;
  std::shared_ptr<const DrawContexts> contexts_;
  std::unique_ptr<TilePainter> painter_, other_;  // other_: of the other thread; may be none
  render::Clusters clusters_;
  render::ViewCut view_cut_;
  std::vector<std::uint32_t> full_ends_;  // of clusters, in the full resolution
  // From prepare() to upload().
  struct Prepared {
    std::vector<std::uint32_t> full;
    render::TextureImage texture{};
    std::vector<std::uint8_t> texels;
  };
  std::unique_ptr<Prepared> prepared_;
  // The cut: its triangles, where clusters end in them (if it is clustered), and the levels of an
  // even one.
  std::vector<std::uint32_t> cut_, cut_ends_, even_levels_;
  std::vector<render::Morph> morphs_;  // of its vertices
  bool clustered_ = false;
  FrameContent content_;
  std::vector<std::size_t> all_, operators_;  // tiles: numbers of the plan's
  std::vector<std::size_t> wall_first_;       // the same, as they are taken
  TileQueue queue_;
  std::vector<render::TileView> views_;
  std::vector<PaintStep> steps_;                       // of the last draw() or refine()
  std::vector<std::uint8_t> pixels_, refined_pixels_;  // shown, and refined until it is whole
  int scale_ = 1;
  // Operator's views' time as a share of the wall tiles', at the same level; of the last frames.
  double operator_share_ = 0.3;
  bool refining_begins_ = false;  // what is refined was not uploaded yet
};

}  // namespace merlin::wall
