#include "daemon/wall/shown_models.h"

#include <utility>

#include <fmt/format.h>

namespace merlin::wall {
namespace {

Result<ReadyModel> prepare(std::size_t place, Model model, const WallSettings& settings) {
  ReadyModel ready{place, std::move(model.path),
                   std::make_unique<const render::lod::Dendrogram>(std::move(model.dendrogram)),
                   nullptr};
  auto content = render::content::ModelContent::make(*ready.model, settings.render.model,
                                                     settings.scene.model_radius_m);
  if (!content) return Error{content.error().code, ready.path + ": " + content.error().what};
  ready.content = *std::move(content);
  return ready;
}

}  // namespace

Result<std::unique_ptr<ShownModels>> ShownModels::make(
    std::vector<Model> models, const render::tiles::TilePlan& plan, const WallSettings& settings,
    ModelWatch& watch, const Eigen::Isometry3f& T_eye_model, const Clock& clock) {
  std::unique_ptr<ShownModels> shown(new ShownModels(watch, plan, clock));
  auto contexts = render::frame::DrawContexts::make(settings.render.gl);
  if (!contexts) return contexts.error();
  shown->contexts_ = *std::move(contexts);
  for (Model& model : models) {
    auto ready = prepare(shown->shown_.size(), std::move(model), settings);
    if (!ready) return ready.error();
    auto attached = shown->attach(*std::move(ready), T_eye_model);
    if (!attached) return attached.error();
    shown->shown_.push_back(*std::move(attached));
  }
  return shown;
}

Result<ShownModels::Shown> ShownModels::attach(ReadyModel ready,
                                               const Eigen::Isometry3f& T_eye_model) const {
  auto renderer =
      render::frame::FrameRenderer::make(std::move(ready.content), plan_, contexts_, clock_);
  if (!renderer) return Error{renderer.error().code, ready.path + ": " + renderer.error().what};
  (*renderer)->warmUp(T_eye_model);
  return Shown{std::move(ready.model), *std::move(renderer)};
}

ModelWatch::Make ShownModels::maker(const WallSettings& settings) {
  return [&](std::size_t place, const std::string& path) -> Result<ReadyModel> {
    auto model = readModel(path, settings.render.model.show);
    if (!model) return model.error();
    return prepare(place, *std::move(model), settings);
  };
}

std::vector<ShownContent> ShownModels::contents() const {
  std::vector<ShownContent> contents;
  for (std::size_t place = 0; place < shown_.size(); ++place) contents.push_back(contentAt(place));
  return contents;
}

std::optional<ContentSource::Replacement> ShownModels::take(bool moving,
                                                            const Eigen::Isometry3f& T_eye_model) {
  const Timestamp now = clock_.now();
  if (!waiting_) {
    waiting_ = watch_.take();
    waits_since_ = now;
  }
  if (!waiting_ || (moving && now - waits_since_ < kPatience)) return std::nullopt;
  ReadyModel ready = *std::exchange(waiting_, std::nullopt);
  const std::size_t place = ready.place;
  const std::string path = ready.path;
  auto attached = attach(std::move(ready), T_eye_model);
  if (!attached) {
    watch_.say(
        fmt::format("the model's file was replaced by one that cannot be shown ({}); the "
                    "model that was read before stays",
                    attached.error().what));
    return std::nullopt;
  }
  watch_.say(fmt::format("model {} was replaced and is shown", path));
  // The old renderer is destroyed before the model that it borrows.
  shown_[place].renderer = std::move(attached->renderer);
  shown_[place].model = std::move(attached->model);
  return Replacement{place, contentAt(place)};
}

}  // namespace merlin::wall
