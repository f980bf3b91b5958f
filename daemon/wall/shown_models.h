// ShownModels: the wall's models and their renderers, by place (the content's index). A model is
// replaced while the wall runs if its file was replaced.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "config/settings.h"
#include "daemon/wall/model_watch.h"
#include "daemon/wall/wall_loop.h"
#include "render/frame/frame_renderer.h"

namespace merlin::wall {

// Thread-bound to the wall's thread.
class ShownModels final : public ContentSource {
 public:
  // `plan`, `watch` and `clock` must outlive this object. Errors: those of DrawContexts::make(),
  // and those of ModelContent and FrameRenderer, with the file's name.
  static Result<std::unique_ptr<ShownModels>> make(std::vector<Model> models,
                                                   const render::tiles::TilePlan& plan,
                                                   const WallSettings& settings, ModelWatch& watch,
                                                   const Eigen::Isometry3f& T_eye_model,
                                                   const Clock& clock);

  // Returns the function with which ModelWatch reads and prepares a replaced file on its own
  // thread. `settings` must outlive it.
  static ModelWatch::Make maker(const WallSettings& settings);

  std::vector<ShownContent> contents() const;
  const render::frame::DrawContexts& contexts() const { return *contexts_; }

  // Returns a replaced model as soon as nothing moves, or after kPatience if motion does not end.
  std::optional<Replacement> take(bool moving, const Eigen::Isometry3f& T_eye_model) override;

  static constexpr Duration kPatience = std::chrono::seconds(5);

 private:
  struct Shown {
    std::unique_ptr<const render::lod::Dendrogram> model;  // the renderer's content borrows it
    std::unique_ptr<render::frame::FrameRenderer> renderer;
  };
  ShownModels(ModelWatch& watch, const render::tiles::TilePlan& plan, const Clock& clock)
      : watch_(watch), plan_(plan), clock_(clock) {}
  Result<Shown> attach(ReadyModel ready, const Eigen::Isometry3f& T_eye_model) const;
  ShownContent contentAt(std::size_t place) const {
    const render::content::Content& content = shown_[place].renderer->content();
    return {&content.detail(), shown_[place].renderer.get(), content.navigation()};
  }

  ModelWatch& watch_;
  const render::tiles::TilePlan& plan_;
  const Clock& clock_;
  std::shared_ptr<const render::frame::DrawContexts> contexts_;
  std::vector<Shown> shown_;  // by place
  std::optional<ReadyModel> waiting_;
  Timestamp waits_since_{};
};

}  // namespace merlin::wall
