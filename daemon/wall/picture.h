// Picture: the frame that the wall shows, drawn from a model tile by tile: a cut at once, or full
// detail in slices.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/wall/painter.h"
#include "render/gl/frame_buffer.h"
#include "render/gl/gl_context.h"
#include "render/gl/model_renderer.h"
#include "render/lod/clusters.h"
#include "render/lod/dendrogram.h"
#include "render/lod/view_cut.h"
#include "render/tiles/tile_plan.h"

namespace merlin::wall {

// Thread-bound: made, used and destroyed on the wall's thread (its GL context is current there).
class Picture final : public Painter {
 public:
  // `radius_m`: the model is scaled to a bounding sphere of this radius about its box's centre.
  // The model is borrowed. `context`: another picture's, of this thread, to be drawn in as well;
  // none: one of its own. Errors: kUnsupported (no GL of that kind, or not enough of it),
  // kInvalidArgument (no such feature to be shown), kMalformed (a texture that cannot be read).
  static Result<std::unique_ptr<Picture>> make(
      const render::Dendrogram& model, const render::TilePlan& plan,
      const render::RenderSettings& settings, double radius_m, const Clock& clock,
      std::shared_ptr<const render::GlContext> context = nullptr);

  // Draws every state that a frame uses once, so that no shader is compiled in a frame.
  void warmUp(const Eigen::Isometry3f& T_eye_model);

  DrawTimes draw(const Eigen::Isometry3f& T_eye_model, std::size_t level, Timestamp until) override;
  void beginRefining(const Eigen::Isometry3f& T_eye_model) override;
  bool beginRefiningTo(const Eigen::Isometry3f& T_eye_model, std::size_t level) override;
  bool refine(Timestamp until) override;
  void setScale(int divisor) override { scale_ = divisor; }
  std::span<const PaintStep> steps() const noexcept override { return steps_; }
  std::span<std::uint8_t> pixels() noexcept override { return pixels_; }

  const std::shared_ptr<const render::GlContext>& context() const noexcept { return context_; }
  const std::string& renderer() const noexcept { return context_->renderer(); }

 private:
  Picture(const render::Dendrogram& model, const render::TilePlan& plan,
          const render::RenderSettings& settings, double radius_m, const Clock& clock);
  render::Camera cameraOf(const render::Tile& tile, const Eigen::Isometry3f& T_eye_model) const;
  render::TileView viewOf(std::size_t tile, const Eigen::Isometry3f& T_eye_model) const;
  void viewAll(const Eigen::Isometry3f& T_eye_model);  // fills views_
  // Triangles of one draw call, in the order of its source.
  struct Run {
    std::size_t first = 0, count = 0;
  };
  // How far a list of runs is drawn.
  struct Progress {
    std::size_t run = 0, triangles = 0;
  };
  // What is drawn at `level`, for these views; drawTile's `view` is a number of theirs.
  void chooseCut(std::size_t level, std::span<const render::TileView> views);
  void morph(std::size_t level, bool uneven);
  void chooseRuns(std::size_t view);
  void drawSlice(Progress& at);
  Timestamp stepDone(shm::StepKind kind, std::size_t tile, Timestamp began);  // returns now
  void drawTile(std::size_t tile, std::size_t view, const Eigen::Isometry3f& T_eye_model,
                DrawTimes& times);
  std::size_t levelThatFits(std::size_t level, Duration wall, Duration left) const;
  void learnOperatorShare(Duration wall, Duration operators);
  void beginTile(std::size_t tile, const Eigen::Isometry3f& T_eye_model, int scale);
  void readTile(std::size_t tile, int scale, std::vector<std::uint8_t>& frame);

  const render::Dendrogram& model_;
  render::TilePlan plan_;
  render::RenderSettings settings_;
  float radius_m_;
  Eigen::Matrix4f metres_from_model_;  // scale and centring
  const Clock& clock_;
  std::shared_ptr<const render::GlContext> context_;
  std::unique_ptr<render::ModelRenderer> renderer_;
  std::vector<render::FrameBuffer> tiles_;
  render::Clusters clusters_;
  render::ViewCut view_cut_;
  std::vector<std::uint32_t> full_ends_;  // of clusters, in the full resolution
  // The cut that is uploaded: its triangles, where clusters end in them (if it is clustered), and
  // the levels of an even one.
  std::vector<std::uint32_t> cut_, cut_ends_, even_levels_;
  std::vector<render::Morph> morphs_;  // of its vertices
  bool clustered_ = false;
  render::ModelRenderer::Source source_ = render::ModelRenderer::Source::kCut;
  std::vector<std::size_t> operators_;  // the operator's tiles, numbers of the plan's
  std::vector<render::TileView> views_;
  std::vector<Run> runs_;
  std::vector<PaintStep> steps_;                       // of the last draw() or refine()
  std::vector<std::uint8_t> pixels_, refined_pixels_;  // shown, and refined until it is whole
  std::vector<std::uint8_t> small_;                    // of a tile that is enlarged
  int scale_ = 1;
  // Operator's views' time as a share of the wall tiles', at the same level; of the last frames.
  double operator_share_ = 0.3;
  // Where refining is.
  Eigen::Isometry3f refined_view_ = Eigen::Isometry3f::Identity();
  std::size_t refined_tile_ = 0;
  bool refined_begun_ = false;
  Progress refined_;
  Duration slice_time_ = std::chrono::milliseconds(4);  // of the last slices, the worst, fading
};

}  // namespace merlin::wall
