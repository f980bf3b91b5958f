#include "render/content/model_content.h"

#include <algorithm>

#include "render/content/model_renderer.h"
#include "render/content/shown_colours.h"

namespace merlin::render::content {
namespace {

// Triangles per slice; a slice takes 1 to 5 ms on llvmpipe. Larger slices are not more efficient,
// since the bins of llvmpipe then exceed the L2 cache.
constexpr std::size_t kSlice = 10'000;

// Returns the transform that centres the model's bounding box at the origin and scales half its
// diagonal to `radius_m`.
Eigen::Matrix4f scaling(const lod::Dendrogram& model, float radius_m) {
  const mesh::Box box = mesh::boundingBox(model.arrays().positions);
  const float half = box.diagonal() / 2;
  const float scale = half > 0 ? radius_m / half : 1;
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity() * scale;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    m(k, 3) = -scale * (box.low[i] + box.high[i]) / 2;
  }
  m(3, 3) = 1;
  return m;
}

Eigen::Matrix4f boxOf(const lod::Dendrogram& model, const Eigen::Matrix4f& metres_from_model) {
  const mesh::Box box = mesh::boundingBox(model.arrays().positions);
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    m(k, k) = metres_from_model(k, k) * (box.high[i] - box.low[i]) / 2;
  }
  return m;
}

// Returns the model's texture; an empty image if it has none.
Result<image::ImageFile> textureOf(const lod::Dendrogram& model) {
  const auto bytes = model.arrays().texture;
  if (bytes.empty()) return image::ImageFile{};
  auto image = image::decodeImage(bytes);
  if (!image) return Error{image.error().code, "the model's texture: " + image.error().what};
  return image;
}

// Draws the content's current choice in one context.
class ModelContentRenderer final : public ContentRenderer {
 public:
  ModelContentRenderer(std::unique_ptr<ModelRenderer> renderer, const ModelDrawList& list,
                       const Eigen::Matrix4f& metres_from_model, const RenderStyle& style)
      : renderer_(std::move(renderer)),
        list_(list),
        metres_from_model_(metres_from_model),
        style_(style) {}

  void beginFrame() override {
    if (!list_.full) renderer_->uploadCut(list_.cut);
    renderer_->morph(list_.morphs);
  }

  void beginView(std::size_t tile, int width, int height) override {
    const ContentView& view = list_.views[tile];
    renderer_->begin(width, height,
                     {view.clip_from_metres * metres_from_model_, view.eye_from_content}, style_);
  }

  bool drawSlice(std::size_t tile, DrawProgress& progress) override {
    const auto& runs = list_.runs[tile];
    const auto source = list_.full ? ModelRenderer::Source::kFull : ModelRenderer::Source::kCut;
    for (std::size_t left = kSlice; left > 0 && progress.part < runs.size();) {
      const TriangleRun& run = runs[progress.part];
      const std::size_t count = std::min(left, run.count - progress.done);
      renderer_->draw(source, run.first + progress.done, count);
      left -= count;
      progress.done += count;
      if (progress.done == run.count) progress = {progress.part + 1, 0};
    }
    return progress.part == runs.size();
  }

 private:
  std::unique_ptr<ModelRenderer> renderer_;
  const ModelDrawList& list_;
  Eigen::Matrix4f metres_from_model_;
  RenderStyle style_;
};

}  // namespace

ModelContent::ModelContent(const lod::Dendrogram& model, const ModelSettings& settings,
                           float radius_m)
    : model_(model),
      detail_(model),
      settings_(settings),
      radius_m_(radius_m),
      metres_from_model_(scaling(model, radius_m)),
      T_content_box_(boxOf(model, metres_from_model_)),
      clusters_(model, {}),
      view_cut_(model, clusters_, settings.style.draw_back_faces),
      cut_ends_(clusters_.size() + 1),
      even_levels_(clusters_.size()) {}

Result<std::unique_ptr<ModelContent>> ModelContent::make(const lod::Dendrogram& model,
                                                         const ModelSettings& settings,
                                                         double radius_m) {
  std::unique_ptr<ModelContent> content(
      new ModelContent(model, settings, static_cast<float>(radius_m)));
  auto texture = textureOf(model);
  if (!texture) return texture.error();
  content->upload_ = std::make_unique<Upload>();
  content->upload_->texture = *std::move(texture);
  content->clusters_.everything(content->upload_->full, content->full_ends_);
  return content;
}

Result<std::unique_ptr<ContentRenderer>> ModelContent::attach(const gl::GlApi& gl) const {
  const image::ImageFile& image = upload_->texture;
  const gl::TextureImage texture{image.width, image.height, image.pixels};
  auto renderer = ModelRenderer::make(gl, model_, upload_->full, settings_.show,
                                      image.pixels.empty() ? nullptr : &texture);
  if (!renderer) return renderer.error();
  return std::unique_ptr<ContentRenderer>(std::make_unique<ModelContentRenderer>(
      *std::move(renderer), list_, metres_from_model_, settings_.style));
}

void ModelContent::choose(std::size_t step, std::span<const ContentView> views) {
  tile_views_.clear();
  for (const ContentView& view : views) {
    if (list_.views.size() <= view.tile) {
      list_.views.resize(view.tile + 1);
      list_.runs.resize(view.tile + 1);
    }
    list_.views[view.tile] = view;
    tile_views_.push_back({view.clip_from_metres * metres_from_model_, view.width_px, view.weight});
  }
  const bool uneven = step > 0 && settings_.view_dependent &&
                      view_cut_.choose(tile_views_, model_.trianglesAt(step));
  if (!uneven) view_cut_.look(tile_views_);
  list_.full = step == 0;
  clustered_ = uneven || step == 0 || clusters_.isClustered(step);
  const std::size_t triangles = step == 0 ? 0 : cutTo(step, uneven);
  list_.cut = std::span(cut_).first(3 * triangles);
  if (step == 0) morphs_.clear();
  list_.morphs = morphs_;
  for (std::size_t view = 0; view < views.size(); ++view)
    chooseRuns(view, list_.runs[views[view].tile]);
}

// Fills cut_ and morphs_; returns the number of triangles.
std::size_t ModelContent::cutTo(std::size_t level, bool uneven) {
  const std::size_t budget = model_.trianglesAt(level);
  if (cut_.size() < 3 * budget) cut_.resize(3 * budget);
  if (uneven)
    lod::morphsAt(model_, clusters_, view_cut_.levels(), settings_.geomorph, morphs_);
  else
    lod::morphsAt(model_, level, settings_.geomorph, morphs_);
  if (clustered_ && !uneven)
    std::fill(even_levels_.begin(), even_levels_.end(), static_cast<std::uint32_t>(level));
  const auto levels = uneven ? view_cut_.levels() : std::span<const std::uint32_t>(even_levels_);
  return clustered_ ? clusters_.cut(levels, cut_, cut_ends_) : clusters_.cutEvenly(level, cut_);
}

// Collects the triangles of clusters that the view may see; adjacent ones are merged into one run.
void ModelContent::chooseRuns(std::size_t view, std::vector<TriangleRun>& runs) const {
  runs.clear();
  if (!list_.full && !clustered_) {
    runs.push_back({0, list_.cut.size() / 3});
    return;
  }
  const auto& ends = list_.full ? full_ends_ : cut_ends_;
  std::size_t first = 0;
  for (std::size_t c = 0; c <= clusters_.size(); ++c) {
    const std::size_t count = ends[c] - first;
    const bool seen = c == clusters_.size() || view_cut_.sees(view, c);
    if (seen && count > 0) {
      if (!runs.empty() && runs.back().first + runs.back().count == first)
        runs.back().count += count;
      else
        runs.push_back({first, count});
    }
    first = ends[c];
  }
}

}  // namespace merlin::render::content
