// ShownModels: the wall's models and their pictures, each in its place, some of which are replaced
// while the wall runs.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "config/settings.h"
#include "daemon/wall/model_watch.h"
#include "daemon/wall/picture.h"
#include "daemon/wall/wall_loop.h"

namespace merlin::wall {

// Thread-bound to the wall's thread.
class ShownModels final : public ContentSource {
 public:
  // `plan`, `watch` and `clock` outlive this. Errors: Picture::make()'s, with the file's name.
  static Result<std::unique_ptr<ShownModels>> make(std::vector<Model> models,
                                                   const render::TilePlan& plan,
                                                   const WallSettings& settings, ModelWatch& watch,
                                                   const Eigen::Isometry3f& T_eye_model,
                                                   const Clock& clock);

  // What ModelWatch does on its thread with a file that was replaced.
  static ModelWatch::Make maker(const render::TilePlan& plan, const WallSettings& settings,
                                const Clock& clock);

  std::vector<Content> contents() const;
  const DrawContexts& contexts() const { return *shown_.front().picture->contexts(); }

  // A replaced model, as soon as nothing moves; where motion does not end, after kPatience.
  std::optional<Replacement> take(bool moving, const Eigen::Isometry3f& T_eye_model) override;

  static constexpr Duration kPatience = std::chrono::seconds(5);

 private:
  ShownModels(ModelWatch& watch, const Clock& clock) : watch_(watch), clock_(clock) {}
  Content contentAt(std::size_t place) const {
    return {shown_[place].model.get(), shown_[place].picture.get()};
  }

  ModelWatch& watch_;
  const Clock& clock_;
  std::vector<ReadyModel> shown_;  // by place
  std::optional<ReadyModel> waiting_;
  Timestamp waits_since_{};
};

}  // namespace merlin::wall
