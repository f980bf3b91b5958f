#include "daemon/wall/shown_models.h"

#include <utility>

#include <fmt/format.h>

namespace merlin::wall {
namespace {

Result<ReadyModel> prepare(std::size_t place, Model model, const render::TilePlan& plan,
                           const WallSettings& settings, const Clock& clock) {
  ReadyModel ready{place, std::move(model.path),
                   std::make_unique<const render::Dendrogram>(std::move(model.dendrogram)),
                   nullptr};
  auto picture =
      Picture::prepare(*ready.model, plan, settings.render, settings.scene.model_radius_m, clock);
  if (!picture) return Error{picture.error().code, ready.path + ": " + picture.error().what};
  ready.picture = *std::move(picture);
  return ready;
}

Result<Ok> upload(ReadyModel& ready, std::shared_ptr<const DrawContexts> contexts,
                  const Eigen::Isometry3f& T_eye_model) {
  const auto done = ready.picture->upload(std::move(contexts));
  if (!done) return Error{done.error().code, ready.path + ": " + done.error().what};
  ready.picture->warmUp(T_eye_model);
  return Ok{};
}

}  // namespace

Result<std::unique_ptr<ShownModels>> ShownModels::make(
    std::vector<Model> models, const render::TilePlan& plan, const WallSettings& settings,
    ModelWatch& watch, const Eigen::Isometry3f& T_eye_model, const Clock& clock) {
  auto made = DrawContexts::make(settings.render);
  if (!made) return made.error();
  const std::shared_ptr<const DrawContexts> contexts = *std::move(made);
  std::unique_ptr<ShownModels> shown(new ShownModels(watch, clock));
  for (Model& model : models) {
    auto ready = prepare(shown->shown_.size(), std::move(model), plan, settings, clock);
    if (!ready) return ready.error();
    if (const auto done = upload(*ready, contexts, T_eye_model); !done) return done.error();
    shown->shown_.push_back(*std::move(ready));
  }
  return shown;
}

ModelWatch::Make ShownModels::maker(const render::TilePlan& plan, const WallSettings& settings,
                                    const Clock& clock) {
  return [&](std::size_t place, const std::string& path) -> Result<ReadyModel> {
    auto model = readModel(path, settings.render.show);
    if (!model) return model.error();
    return prepare(place, *std::move(model), plan, settings, clock);
  };
}

std::vector<Content> ShownModels::contents() const {
  std::vector<Content> contents;
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
  if (const auto done = upload(ready, shown_.front().picture->contexts(), T_eye_model); !done) {
    watch_.say(
        fmt::format("the model's file was replaced by one that cannot be shown ({}); the "
                    "model that was read before stays",
                    done.error().what));
    return std::nullopt;
  }
  watch_.say(fmt::format("model {} was replaced and is shown", ready.path));
  const std::size_t place = ready.place;
  std::swap(shown_[place], ready);  // the old picture goes, and then its model
  return Replacement{place, contentAt(place)};
}

}  // namespace merlin::wall
