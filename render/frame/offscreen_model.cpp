#include "render/frame/offscreen_model.h"

#include <utility>

#include "daemon/base/radian.h"
#include "render/content/model_content.h"

namespace merlin::render::frame {

Eigen::Isometry3f ModelView::T_eye_model() const {
  Eigen::Isometry3f view = Eigen::Isometry3f::Identity();
  view.rotate(
      Eigen::AngleAxisf(static_cast<float>(yaw_deg) * kRadian<float>, Eigen::Vector3f::UnitY()));
  view.rotate(
      Eigen::AngleAxisf(static_cast<float>(pitch_deg) * kRadian<float>, Eigen::Vector3f::UnitX()));
  return view;
}

Result<OffscreenModel> OffscreenModel::make(const lod::Dendrogram& model, const ModelView& view,
                                            const Clock& clock) {
  tiles::TilesSettings tiles;
  tiles.tile_width = tiles.frame_width = view.width;
  tiles.tile_height = tiles.frame_height = view.height;
  tiles.tiles = {{"model", tiles::TileKind::kOperator, 0, 0, 0}};
  auto plan = tiles::planTiles(tiles);
  if (!plan) return plan.error();
  OffscreenModel made(view);
  made.plan_ = std::make_unique<const tiles::TilePlan>(*std::move(plan));
  content::ModelSettings settings = view.model;
  settings.view_dependent = false;
  settings.geomorph = 0;
  auto contexts = DrawContexts::make({view.backend, 1, 0});
  if (!contexts) return contexts.error();
  auto content = content::ModelContent::make(model, settings, 1.0);
  if (!content) return content.error();
  auto renderer =
      FrameRenderer::make(*std::move(content), *made.plan_, *std::move(contexts), clock);
  if (!renderer) return renderer.error();
  made.renderer_ = *std::move(renderer);
  return made;
}

image::Image OffscreenModel::draw(std::size_t level) {
  renderer_->draw({.T_eye_content = view_.T_eye_model(), .step = level});
  const auto pixels = renderer_->pixels();
  return {view_.width, view_.height, {pixels.begin(), pixels.end()}};
}

}  // namespace merlin::render::frame
