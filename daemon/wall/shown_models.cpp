#include "daemon/wall/shown_models.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace merlin::wall {

using render::content::Picture;
using render::content::PictureKind;

Result<ReadyModel> prepareContent(std::size_t place, WallContent content,
                                  const WallSettings& settings) {
  ReadyModel ready{place, std::move(content.file), nullptr, nullptr};
  ready.name = content.entry.name;
  ready.stamp = content.stamp;
  ready.is_slide = content.entry.kind == ContentKind::kSlides;
  ready.is_first_slide = content.is_first_slide;
  ready.is_last_slide = content.is_last_slide;
  ready.left_out = std::move(content.left_out);
  if (!content.isModel()) {
    ready.picture = std::get<1>(std::move(content.data));
    return ready;
  }
  ready.model =
      std::make_unique<const render::lod::Dendrogram>(std::get<0>(std::move(content.data)));
  auto made = render::content::ModelContent::make(*ready.model, settings.render.model,
                                                  settings.scene.model_radius_m);
  if (!made) return Error{made.error().code, ready.path + ": " + made.error().what};
  ready.content = *std::move(made);
  return ready;
}

Result<std::unique_ptr<ShownModels>> ShownModels::make(std::vector<WallContent> contents,
                                                       const Parts& parts,
                                                       const Eigen::Isometry3f& T_eye_model) {
  std::unique_ptr<ShownModels> shown(new ShownModels(parts));
  auto contexts = render::frame::DrawContexts::make(parts.settings.render.gl);
  if (!contexts) return contexts.error();
  shown->contexts_ = *std::move(contexts);
  if (const auto made = shown->makeViewer(T_eye_model); !made) return made.error();
  for (WallContent& content : contents) {
    ContentEntry entry = content.entry;
    const bool missing = !content.fault.empty();
    auto ready = prepareContent(shown->shown_.size(), std::move(content), parts.settings);
    if (!ready) return ready.error();
    const auto added = shown->add(*std::move(ready), std::move(entry), T_eye_model);
    if (!added) return added.error();
    shown->shown_.back().missing = missing;
  }
  shown->shown_.emplace_back().picture = render::content::noPicture();
  shown->prepare(0);
  return shown;
}

// The renderer of pictures is made before the first frame even if no picture is configured, so that
// no shader must be compiled when a picture is shown later, and its first frame is in time.
Result<Ok> ShownModels::makeViewer(const Eigen::Isometry3f& T_eye_model) {
  std::size_t wall_px = 0;
  for (const render::tiles::Tile& tile : parts_.plan.tiles)
    wall_px += static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  const render::content::PictureMemory memory{
      static_cast<std::size_t>(parts_.settings.render.picture_memory_mb) << 20,
      contexts_->other ? std::size_t{2} : std::size_t{1}};
  auto content = std::make_unique<render::content::PictureContent>(
      render::content::noPicture(), parts_.tiles, parts_.settings.scene.model_radius_m, wall_px,
      memory);
  content->setBackground(parts_.settings.render.model.style.background);
  pictures_ = content.get();
  auto renderer =
      render::frame::FrameRenderer::make(std::move(content), parts_.plan, contexts_, parts_.clock);
  if (!renderer) return Error{renderer.error().code, "pictures: " + renderer.error().what};
  viewer_ = *std::move(renderer);
  viewer_->warmUp(T_eye_model);
  return Ok{};
}

Result<Ok> ShownModels::add(ReadyModel ready, ContentEntry entry,
                            const Eigen::Isometry3f& T_eye_model) {
  Shown shown{std::move(entry), nullptr, nullptr, ready.picture, ready.path};
  shown.is_first_slide = ready.is_first_slide;
  shown.is_last_slide = ready.is_last_slide;
  if (!ready.picture) {
    auto renderer = attach(ready, T_eye_model);
    if (!renderer) return renderer.error();
    shown.renderer = *std::move(renderer);
    shown.model = std::move(ready.model);
  }
  shown_.push_back(std::move(shown));
  return Ok{};
}

Result<std::unique_ptr<render::frame::FrameRenderer>> ShownModels::attach(
    ReadyModel& ready, const Eigen::Isometry3f& T_eye_model) const {
  auto renderer = render::frame::FrameRenderer::make(std::move(ready.content), parts_.plan,
                                                     contexts_, parts_.clock);
  if (!renderer) return Error{renderer.error().code, ready.path + ": " + renderer.error().what};
  (*renderer)->warmUp(T_eye_model);
  return renderer;
}

ModelWatch::Make ShownModels::maker(const std::vector<ContentEntry>& entries,
                                    const WallSettings& settings) {
  return [&](std::size_t place, const std::string& path) -> Result<ReadyModel> {
    ContentEntry entry;
    if (place < entries.size()) {
      entry = entries[place];
    } else {
      const std::string& folder = settings.shown.folder;
      const auto there =
          contentBelow(folder, path.substr(std::min(folder.size() + 1, path.size())));
      if (!there) return there.error();
      entry = *there;
    }
    // Reads only the slide that was replaced; or the folder, if none of its slides could be shown
    // before.
    const bool slide = entry.kind == ContentKind::kSlides && path != entry.path;
    if (slide) entry.kind = ContentKind::kPicture;
    entry.path = path;
    std::vector<std::string> skipped;
    auto read = readContent(entry, settings.render.model.show, {}, skipped);
    if (!read) return read.error();
    auto ready = prepareContent(place, *std::move(read), settings);
    if (ready) ready->is_slide = ready->is_slide || slide;
    return ready;
  };
}

// Returns the nearest viewing distance for a picture, as a multiple of the initial one: that at
// which one pixel of the picture is as wide as eight pixels of the wall.
float ShownModels::nearestOf(const Picture& picture) const {
  constexpr double kMostSize = 8;
  const render::image::PyramidLevel& finest = picture.file->levels().front();
  const render::scene::SceneSettings& scene = parts_.settings.scene;
  const double pixel_m =
      2 * scene.model_radius_m /
      std::hypot(static_cast<double>(finest.width), static_cast<double>(finest.height));
  double focal_px = 1;
  for (const render::tiles::Tile& tile : parts_.plan.tiles) {
    if (tile.followsWall())
      focal_px = std::max(focal_px, double{tile.projection(0, 0)} * tile.width / 2);
  }
  const double nearest = pixel_m * focal_px / kMostSize / scene.model_distance_m;
  return std::clamp(static_cast<float>(nearest), 1e-6F, render::content::kNearestPlane);
}

ShownContent ShownModels::contentAt(std::size_t place) const {
  const Shown& shown = shown_[place];
  if (!shown.picture) {
    const render::content::Content& content = shown.renderer->content();
    return {&content.detail(),
            shown.renderer.get(),
            content.navigation(),
            render::content::kNearestPlane,
            shown.entry.name,
            "model",
            {}};
  }
  const bool panorama = shown.picture->kind == PictureKind::kPanorama;
  const bool slides = shown.entry.kind == ContentKind::kSlides;
  using render::content::Navigation;
  return {&pictures_->detail(),
          viewer_.get(),
          panorama ? Navigation::kPanorama : Navigation::kPlane,
          nearestOf(*shown.picture),
          shown.entry.name,
          panorama ? "panorama" : "picture",
          slides && !shown.missing ? std::filesystem::path(shown.file).stem().string() : "",
          shown.missing};
}

std::vector<ShownContent> ShownModels::contents() const {
  std::vector<ShownContent> contents;
  for (std::size_t place = 0; place < shown_.size(); ++place) contents.push_back(contentAt(place));
  return contents;
}

// Gives the renderer of pictures the picture of this place. If the renderer already has it, the
// tiles that were loaded are kept.
void ShownModels::prepare(std::size_t place) {
  const Shown& shown = shown_[place];
  if (!shown.picture) return;
  viewed_ = place;
  if (&pictures_->picture() != shown.picture.get()) pictures_->show(shown.picture);
}

// At the last slide, returns false if there is another content, which then follows; the first slide
// is requested nevertheless, so that it is ready for later.
bool ShownModels::nextWithin(std::size_t place) {
  const Shown& shown = shown_[place];
  if (shown.entry.kind != ContentKind::kSlides) return false;
  const bool more = !shown.is_last_slide || isAlone(place);
  askForSlide(place, {shown.file, false}, more);
  return more;
}

// At the first slide, returns false if there is another content: the previous content is then
// shown. If there is none, requests the last slide.
bool ShownModels::previousWithin(std::size_t place) {
  const Shown& shown = shown_[place];
  if (shown.entry.kind != ContentKind::kSlides) return false;
  const bool more = !shown.is_first_slide || isAlone(place);
  if (more) askForSlide(place, {shown.file, true}, true);
  return more;
}

void ShownModels::askForSlide(std::size_t place, const SlideTurn& turn, bool to_be_shown) {
  ModelWatch& watch = parts_.watch;
  const WallSettings& settings = parts_.settings;
  const auto read = [&watch, &settings, place, turn, to_be_shown,
                     entry = shown_[place].entry]() -> Result<ReadyModel> {
    std::vector<std::string> skipped;
    auto slide = readContent(entry, settings.render.model.show, turn, skipped);
    watch.reportSkipped(skipped);
    if (!slide) return slide.error();
    auto ready = prepareContent(place, *std::move(slide), settings);
    if (ready) ready->asked_for = to_be_shown;
    return ready;
  };
  watch.askForSlide(read, place);
}

void ShownModels::takePicture(ReadyModel& ready) {
  Shown& shown = shown_[ready.place];
  shown.renderer.reset();
  shown.model.reset();
  shown.picture = std::move(ready.picture);
  if (viewed_ == ready.place) pictures_->show(shown.picture);
}

Result<Ok> ShownModels::takeModel(ReadyModel& ready, const Eigen::Isometry3f& T_eye_model) {
  auto renderer = attach(ready, T_eye_model);
  if (!renderer) {
    parts_.watch.report(faultEvent(fmt::format(
        "a model cannot be shown ({}); what was shown before stays", renderer.error().what)));
    return renderer.error();
  }
  Shown& shown = shown_[ready.place];
  shown.picture.reset();
  // The old renderer is destroyed before the old model, which it uses.
  shown.renderer = *std::move(renderer);
  shown.model = std::move(ready.model);
  return Ok{};
}

ContentSource::Replacement ShownModels::refusal(const ReadyModel& ready, std::string why) {
  return {ready.place, {}, false, ready.request, std::move(why), ready.is_slide};
}

// Stores which file is now shown at its place. The entry of the last place, which is for files that
// are not in the configuration, is filled in only here.
void ShownModels::noteFile(const ReadyModel& ready, ContentKind kind) {
  Shown& shown = shown_[ready.place];
  if (std::exchange(shown.missing, false)) {
    parts_.missing.nowShown(ready.place);
    parts_.watch.report(
        newsEvent(fmt::format("{} can be read now, and is shown in its turn", shown.entry.path)));
  }
  shown.file = ready.path;
  if (!ready.was_replaced) {  // a replaced slide keeps its position in the list
    shown.is_first_slide = ready.is_first_slide;
    shown.is_last_slide = ready.is_last_slide;
  }
  if (ready.place < listed()) return;
  shown.entry.name = ready.name;
  shown.entry.below = parts_.settings.shown.folder;
  shown.entry.kind = ready.is_slide ? ContentKind::kSlides : kind;
  shown.entry.path =
      ready.is_slide ? std::filesystem::path(ready.path).parent_path().string() : ready.path;
}

std::optional<ContentSource::Replacement> ShownModels::take(bool moving,
                                                            const Eigen::Isometry3f& T_eye_model) {
  // The exception ends the wall's thread and thereby the process; the restarted process creates a
  // new context.
  if (contexts_->own->wasReset())
    throw std::runtime_error("the GPU was reset, and what it held is lost");
  const Timestamp now = parts_.clock.now();
  if (!waiting_) {
    waiting_ = parts_.watch.take();
    waits_since_ = now;
  }
  if (!waiting_) return std::nullopt;
  const bool model = waiting_->content != nullptr;
  if (model && moving && now - waits_since_ < kPatience) return std::nullopt;
  ReadyModel ready = *std::exchange(waiting_, std::nullopt);
  if (!ready.refused.empty()) return refusal(ready, ready.refused);
  if (model) {
    const auto taken = takeModel(ready, T_eye_model);
    if (!taken) return refusal(ready, taken.error().what);
  } else {
    takePicture(ready);
  }
  noteFile(ready, model ? ContentKind::kModel : ContentKind::kPicture);
  if (ready.was_replaced) {
    parts_.watch.report(newsEvent(
        fmt::format("{} {} was replaced and is shown", model ? "model" : "picture", ready.path)));
  }
  return Replacement{ready.place, contentAt(ready.place), ready.asked_for, ready.request, {},
                     false};
}

}  // namespace merlin::wall
