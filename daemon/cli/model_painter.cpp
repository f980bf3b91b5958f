#include "daemon/cli/model_painter.h"

#include <cassert>
#include <numbers>

namespace merlin::cli {
void Image::append(const Image& right) {
  if (pixels.empty()) height = right.height;
  assert(right.height == height);
  std::vector<std::uint8_t> wider;
  wider.reserve(pixels.size() + right.pixels.size());
  const auto row = [](const Image& image, int y) {
    return image.pixels.begin() + std::ptrdiff_t{4} * y * image.width;
  };
  for (int y = 0; y < height; ++y) {
    for (const Image* image : {static_cast<const Image*>(this), &right})
      wider.insert(wider.end(), row(*image, y), row(*image, y + 1));
  }
  pixels = std::move(wider);
  width += right.width;
}

void View::addTo(Command command) {
  command.option("--yaw", yaw_deg, "Turn about the vertical axis, degrees").showDefault();
  command
      .option("--pitch", pitch_deg,
              "Turn about the horizontal axis before it, degrees; -90 for a model whose up is z")
      .showDefault();
  command
      .option("--show", render.show.feature,
              "A feature as colours, one value on a scale from dark blue to yellow; without: the "
              "model's own")
      .typeName("NAME");
  command.option("--brightness", render.look.brightness, "Multiplies colours")
      .range(0.1, 10.0)
      .showDefault();
  command.option("--backend", backend, "Which windowless OpenGL draws")
      .oneOf({"egl", "osmesa"})
      .showDefault();
}

Eigen::Isometry3f View::T_eye_model() const {
  constexpr float kRadian = std::numbers::pi_v<float> / 180;
  Eigen::Isometry3f view = Eigen::Isometry3f::Identity();
  view.rotate(Eigen::AngleAxisf(static_cast<float>(yaw_deg) * kRadian, Eigen::Vector3f::UnitY()));
  view.rotate(Eigen::AngleAxisf(static_cast<float>(pitch_deg) * kRadian, Eigen::Vector3f::UnitX()));
  return view;
}

Result<ModelPainter> ModelPainter::make(const render::Dendrogram& model, const View& view,
                                        const Clock& clock) {
  render::TilesSettings tiles;
  tiles.tile_width = tiles.frame_width = view.width;
  tiles.tile_height = tiles.frame_height = view.height;
  tiles.tiles = {{"model", render::TileKind::kOperator, 0, 0, 0}};
  const auto plan = render::planTiles(tiles);
  if (!plan) return plan.error();
  ModelPainter painter(view);
  render::RenderSettings settings = view.render;
  settings.view_dependent = false;  // shows a level as it is
  settings.geomorph = 0;
  settings.contexts = 1;  // one tile
  settings.backend =
      view.backend == "osmesa" ? render::GlBackend::kOsmesa : render::GlBackend::kEgl;
  auto picture = wall::Picture::make(model, *plan, settings, 1.0, clock);
  if (!picture) return picture.error();
  painter.picture_ = *std::move(picture);
  return painter;
}

Image ModelPainter::draw(std::size_t level) {
  picture_->draw(view_.T_eye_model(), level, Timestamp::max());
  const auto pixels = picture_->pixels();
  return {view_.width, view_.height, {pixels.begin(), pixels.end()}};
}

}  // namespace merlin::cli
