// ShownModels: owns the wall's contents and their renderers, by place (the content's index). Each
// model has a renderer of its own; all pictures share one. A content is replaced while the wall
// runs if its file was replaced, or if a person requests another one.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/wall/model_watch.h"
#include "daemon/wall/wall_contents.h"
#include "daemon/wall/wall_loop.h"
#include "render/content/picture/picture_content.h"
#include "render/frame/frame_renderer.h"

namespace merlin::wall {

// Prepares a content that was read, to be shown at `place`; for a model, makes its ModelContent.
// May be called on any thread. Errors: those of ModelContent::make(), with the file's name.
Result<ReadyModel> prepareContent(std::size_t place, WallContent content,
                                  const WallSettings& settings);

// Thread-bound to the wall's thread.
class ShownModels final : public ContentSource {
 public:
  // What ShownModels needs; all must outlive it.
  struct Parts {
    const render::tiles::TilePlan& plan;
    const WallSettings& settings;
    ModelWatch& watch;
    MissingContents& missing;
    render::content::TileSource& tiles;
    const Clock& clock;
  };
  // Makes the drawing contexts and the renderers. `contents`: those of the configuration. One more
  // place follows them, for a content that is not in the configuration. `T_eye_model`: the view for
  // the warm-up of the renderers. Errors: those of DrawContexts::make(), and those of
  // ModelContent::make() and FrameRenderer::make(), with the file's name.
  static Result<std::unique_ptr<ShownModels>> make(std::vector<WallContent> contents,
                                                   const Parts& parts,
                                                   const Eigen::Isometry3f& T_eye_model);

  // Returns the function with which ModelWatch reads and prepares a replaced file on its own
  // thread. `entries` and `settings` must outlive the result.
  static ModelWatch::Make maker(const std::vector<ContentEntry>& entries,
                                const WallSettings& settings);

  std::vector<ShownContent> contents() const;
  // Returns the number of contents of the configuration.
  std::size_t listed() const noexcept { return shown_.size() - 1; }
  const render::frame::DrawContexts& contexts() const { return *contexts_; }

  // See ContentSource. Returns a picture at once, and a model as soon as nothing moves, or after
  // kPatience if motion does not end. Throws if the GPU was reset, which ends the wall's thread.
  std::optional<Replacement> take(bool moving, const Eigen::Isometry3f& T_eye_model) override;
  void prepare(std::size_t place) override;
  bool nextWithin(std::size_t place) override;
  bool previousWithin(std::size_t place) override;

  static constexpr Duration kPatience = std::chrono::seconds(5);

 private:
  struct Shown {
    ContentEntry entry;
    std::unique_ptr<const render::lod::Dendrogram> model;  // used by the content of `renderer`
    std::unique_ptr<render::frame::FrameRenderer> renderer;
    // For a picture, instead of `model` and `renderer`.
    std::shared_ptr<const render::content::Picture> picture;
    std::string file;
    bool is_first_slide = false, is_last_slide = false;
    bool missing = false;  // could not be read yet; `picture` is empty
  };
  explicit ShownModels(const Parts& parts) : parts_(parts) {}
  Result<Ok> makeViewer(const Eigen::Isometry3f& T_eye_model);
  Result<Ok> add(ReadyModel ready, ContentEntry entry, const Eigen::Isometry3f& T_eye_model);
  Result<std::unique_ptr<render::frame::FrameRenderer>> attach(
      ReadyModel& ready, const Eigen::Isometry3f& T_eye_model) const;
  // Whether the content of this place is the only content of the configuration.
  bool isAlone(std::size_t place) const noexcept { return place < listed() && listed() == 1; }
  void askForSlide(std::size_t place, const SlideTurn& turn, bool to_be_shown);
  void takePicture(ReadyModel& ready);
  Result<Ok> takeModel(ReadyModel& ready, const Eigen::Isometry3f& T_eye_model);
  void noteFile(const ReadyModel& ready, ContentKind kind);
  static Replacement refusal(const ReadyModel& ready, std::string why);
  ShownContent contentAt(std::size_t place) const;
  float nearestOf(const render::content::Picture& picture) const;

  Parts parts_;
  std::shared_ptr<const render::frame::DrawContexts> contexts_;
  std::unique_ptr<render::frame::FrameRenderer> viewer_;  // renderer of all pictures
  render::content::PictureContent* pictures_ = nullptr;   // content of viewer_
  std::size_t viewed_ = ~std::size_t{0};                  // place whose picture viewer_ shows
  std::vector<Shown> shown_;                              // by place
  std::optional<ReadyModel> waiting_;
  Timestamp waits_since_{};
};

}  // namespace merlin::wall
