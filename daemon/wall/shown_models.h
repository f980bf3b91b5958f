// ShownModels: the wall's models and their renderers, each in its place, some of which are replaced
// while the wall runs.
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
  // `plan`, `watch` and `clock` outlive this. Errors: ModelContent's and FrameRenderer's, with the
  // file's name.
  static Result<std::unique_ptr<ShownModels>> make(std::vector<Model> models,
                                                   const render::TilePlan& plan,
                                                   const WallSettings& settings, ModelWatch& watch,
                                                   const Eigen::Isometry3f& T_eye_model,
                                                   const Clock& clock);

  // Work that ModelWatch does on its own thread with a file that was replaced.
  static ModelWatch::Make maker(const WallSettings& settings);

  std::vector<ShownContent> contents() const;
  const render::DrawContexts& contexts() const { return *contexts_; }

  // A replaced model, as soon as nothing moves; where motion does not end, after kPatience.
  std::optional<Replacement> take(bool moving, const Eigen::Isometry3f& T_eye_model) override;

  static constexpr Duration kPatience = std::chrono::seconds(5);

 private:
  struct Shown {
    std::unique_ptr<const render::Dendrogram> model;  // the renderer's content borrows it
    std::unique_ptr<render::FrameRenderer> renderer;
  };
  ShownModels(ModelWatch& watch, const render::TilePlan& plan, const Clock& clock)
      : watch_(watch), plan_(plan), clock_(clock) {}
  Result<Shown> attach(ReadyModel ready, const Eigen::Isometry3f& T_eye_model) const;
  ShownContent contentAt(std::size_t place) const {
    return {&shown_[place].renderer->content().detail(), shown_[place].renderer.get()};
  }

  ModelWatch& watch_;
  const render::TilePlan& plan_;
  const Clock& clock_;
  std::shared_ptr<const render::DrawContexts> contexts_;
  std::vector<Shown> shown_;  // by place
  std::optional<ReadyModel> waiting_;
  Timestamp waits_since_{};
};

}  // namespace merlin::wall
