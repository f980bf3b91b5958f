#include "daemon/wall/picture.h"

#include <algorithm>
#include <cmath>

#include "render/mesh/io/picture_file.h"

namespace merlin::wall {
namespace {

using render::ModelRenderer;

// Triangles of a slice: 1 to 5 ms on llvmpipe; larger ones are no faster (its bins fall out of L2).
constexpr std::size_t kSlice = 10'000;

// Of the operator's view, where time is short; and how its cost grows with triangles (as the
// governor has it).
constexpr std::size_t kLeastOperator = 300;
// It shows where things are; what they look like the wall shows.
constexpr float kOperatorWeight = 0.1F;
constexpr double kCostExponent = 0.65;

// The model's box centred at the origin, its half diagonal `radius_m` long.
Eigen::Matrix4f scaling(const render::Dendrogram& model, float radius_m) {
  const render::Box box = render::boundingBox(model.arrays().positions);
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

// Nothing where the model has none.
Result<render::PictureFile> textureOf(const render::Dendrogram& model) {
  const auto bytes = model.arrays().texture;
  if (bytes.empty()) return render::PictureFile{};
  auto picture = render::decodePicture(bytes);
  if (!picture) return Error{picture.error().code, "its texture: " + picture.error().what};
  return picture;
}

struct Size {
  int width, height;
};

// Each pixel of `from` as `times` x `times` of them; where `to` is no multiple, the last ones go
// on.
void enlarge(std::span<const std::uint8_t> from, Size size, int times, std::uint8_t* to,
             Size enlarged, int stride_px) {
  for (int y = 0; y < enlarged.height; ++y) {
    const std::uint8_t* row = &from[static_cast<std::size_t>(4) *
                                    static_cast<std::size_t>(std::min(y / times, size.height - 1)) *
                                    static_cast<std::size_t>(size.width)];
    std::uint8_t* out = to + std::ptrdiff_t{4} * y * stride_px;
    for (int x = 0; x < enlarged.width; ++x)
      std::copy_n(row + std::ptrdiff_t{4} * std::min(x / times, size.width - 1), 4, out + 4 * x);
  }
}

}  // namespace

Result<std::unique_ptr<Picture>> Picture::make(const render::Dendrogram& model,
                                               const render::TilePlan& plan,
                                               const render::RenderSettings& settings,
                                               double radius_m, const Clock& clock,
                                               std::shared_ptr<const render::GlContext> context) {
  std::unique_ptr<Picture> picture(new Picture(model, plan, settings, radius_m, clock));
  if (!context) {
    auto made = render::makeGlContext(settings.backend);
    if (!made) return made.error();
    context = *std::move(made);
  }
  picture->context_ = std::move(context);
  const render::GlApi& gl = picture->context_->gl();
  std::vector<std::uint32_t> full;
  picture->clusters_.everything(full, picture->full_ends_);
  const auto texture = textureOf(model);
  if (!texture) return texture.error();
  const render::TextureImage image{texture->width, texture->height, texture->pixels};
  auto renderer = ModelRenderer::make(gl, model, full, settings.show,
                                      texture->pixels.empty() ? nullptr : &image);
  if (!renderer) return renderer.error();
  picture->renderer_ = *std::move(renderer);
  for (const render::Tile& tile : plan.tiles) {
    auto buffer = render::FrameBuffer::make(gl, tile.width, tile.height);
    if (!buffer) return buffer.error();
    picture->tiles_.push_back(*std::move(buffer));
  }
  return picture;
}

Picture::Picture(const render::Dendrogram& model, const render::TilePlan& plan,
                 const render::RenderSettings& settings, double radius_m, const Clock& clock)
    : model_(model),
      plan_(plan),
      settings_(settings),
      radius_m_(static_cast<float>(radius_m)),
      metres_from_model_(scaling(model, radius_m_)),
      clock_(clock),
      clusters_(model, {}),
      view_cut_(model, clusters_, settings.look.draw_back_faces),
      cut_ends_(clusters_.size() + 1),
      even_levels_(clusters_.size()),
      pixels_(std::size_t{4} * static_cast<std::size_t>(plan.frame_width) *
              static_cast<std::size_t>(plan.frame_height)),
      refined_pixels_(pixels_.size()) {
  tiles_.reserve(plan.tiles.size());
  for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
    if (plan.tiles[i].kind == render::TileKind::kOperator) operators_.push_back(i);
  }
}

render::Camera Picture::cameraOf(const render::Tile& tile,
                                 const Eigen::Isometry3f& T_eye_model) const {
  const bool operators = tile.kind == render::TileKind::kOperator;
  const Eigen::Matrix4f view =
      operators ? render::operatorView(tile.projection, T_eye_model.translation(), radius_m_)
                : tile.view;
  // The light comes from the eye, not from the tile: so a surface is as bright on either side of a
  // seam.
  return {tile.projection * view * T_eye_model.matrix() * metres_from_model_, T_eye_model.linear()};
}

void Picture::beginTile(std::size_t tile, const Eigen::Isometry3f& T_eye_model, int scale) {
  const render::Tile& t = plan_.tiles[tile];
  tiles_[tile].bind();
  renderer_->begin(t.width / scale, t.height / scale, cameraOf(t, T_eye_model), settings_.look);
}

void Picture::readTile(std::size_t tile, int scale, std::vector<std::uint8_t>& frame) {
  const render::Tile& t = plan_.tiles[tile];
  const auto at =
      static_cast<std::size_t>(4) * static_cast<std::size_t>(t.y * plan_.frame_width + t.x);
  if (scale == 1) return tiles_[tile].read(frame.data() + at, plan_.frame_width);
  const int width = t.width / scale, height = t.height / scale;
  small_.resize(std::size_t{4} * static_cast<std::size_t>(width) *
                static_cast<std::size_t>(height));
  tiles_[tile].read(small_.data(), width, width, height);
  enlarge(small_, {width, height}, scale, frame.data() + at, {t.width, t.height},
          plan_.frame_width);
}

render::TileView Picture::viewOf(std::size_t tile, const Eigen::Isometry3f& T_eye_model) const {
  const render::Tile& t = plan_.tiles[tile];
  const bool operators = t.kind == render::TileKind::kOperator;
  return {cameraOf(t, T_eye_model).clip_from_model, t.width, operators ? kOperatorWeight : 1};
}

void Picture::viewAll(const Eigen::Isometry3f& T_eye_model) {
  views_.clear();
  for (std::size_t i = 0; i < tiles_.size(); ++i) views_.push_back(viewOf(i, T_eye_model));
}

void Picture::chooseCut(std::size_t level, std::span<const render::TileView> views) {
  const Timestamp began = clock_.now();
  const std::size_t budget = model_.trianglesAt(level);
  const bool uneven = level > 0 && settings_.view_dependent && view_cut_.choose(views, budget);
  if (!uneven) view_cut_.look(views);
  source_ = level == 0 ? ModelRenderer::Source::kFull : ModelRenderer::Source::kCut;
  clustered_ = uneven || level == 0 || clusters_.isClustered(level);
  if (level == 0) return renderer_->morph({});
  if (cut_.size() < 3 * budget) cut_.resize(3 * budget);
  if (clustered_ && !uneven)
    std::fill(even_levels_.begin(), even_levels_.end(), static_cast<std::uint32_t>(level));
  const auto levels = uneven ? view_cut_.levels() : std::span<const std::uint32_t>(even_levels_);
  const std::size_t triangles =
      clustered_ ? clusters_.cut(levels, cut_, cut_ends_) : clusters_.cutEvenly(level, cut_);
  const Timestamp cut = stepDone(shm::StepKind::kCut, 0, began);
  renderer_->uploadCut(std::span(cut_).first(3 * triangles));
  morph(level, uneven);
  stepDone(shm::StepKind::kUpload, 0, cut);
}

void Picture::morph(std::size_t level, bool uneven) {
  if (uneven)
    morphsAt(model_, clusters_, view_cut_.levels(), settings_.geomorph, morphs_);
  else
    morphsAt(model_, level, settings_.geomorph, morphs_);
  renderer_->morph(morphs_);
}

Timestamp Picture::stepDone(shm::StepKind kind, std::size_t tile, Timestamp began) {
  const Timestamp ended = clock_.now();
  steps_.push_back({kind, static_cast<std::uint16_t>(tile), began, ended});
  return ended;
}

// Neighbouring clusters that the view sees are one run.
void Picture::chooseRuns(std::size_t view) {
  runs_.clear();
  if (source_ == ModelRenderer::Source::kCut && !clustered_) {
    runs_.push_back({0, renderer_->triangles(source_)});
    return;
  }
  const auto& ends = source_ == ModelRenderer::Source::kCut ? cut_ends_ : full_ends_;
  std::size_t first = 0;
  for (std::size_t c = 0; c <= clusters_.size(); ++c) {
    const std::size_t count = ends[c] - first;
    const bool seen = c == clusters_.size() || view_cut_.sees(view, c);
    if (seen && count > 0) {
      if (!runs_.empty() && runs_.back().first + runs_.back().count == first)
        runs_.back().count += count;
      else
        runs_.push_back({first, count});
    }
    first = ends[c];
  }
}

void Picture::drawTile(std::size_t tile, std::size_t view, const Eigen::Isometry3f& T_eye_model,
                       DrawTimes& times) {
  const Timestamp began = clock_.now();
  beginTile(tile, T_eye_model, scale_);
  const Timestamp cleared = clock_.now();
  chooseRuns(view);
  for (Progress at; at.run < runs_.size();) {
    drawSlice(at);
    renderer_->flush();
  }
  const Timestamp drawn = stepDone(shm::StepKind::kDraw, tile, began);
  readTile(tile, scale_, pixels_);
  stepDone(shm::StepKind::kReadBack, tile, drawn);
  times.drawing += drawn - cleared;
  times.fixed += (cleared - began) + (clock_.now() - drawn);
}

// About kSlice triangles of the runs, from where `at` is.
void Picture::drawSlice(Progress& at) {
  for (std::size_t left = kSlice; left > 0 && at.run < runs_.size();) {
    const Run& run = runs_[at.run];
    const std::size_t count = std::min(left, run.count - at.triangles);
    renderer_->draw(source_, run.first + at.triangles, count);
    left -= count;
    at.triangles += count;
    if (at.triangles == run.count) at = {at.run + 1, 0};
  }
}

DrawTimes Picture::draw(const Eigen::Isometry3f& T_eye_model, std::size_t level, Timestamp until) {
  DrawTimes times;
  steps_.clear();
  const Timestamp began = clock_.now();
  viewAll(T_eye_model);
  chooseCut(level, views_);
  times.drawing += clock_.now() - began;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    if (plan_.tiles[i].kind == render::TileKind::kWall) drawTile(i, i, T_eye_model, times);
  }
  if (operators_.empty() || operators_.size() == tiles_.size()) until = Timestamp::max();
  const Duration wall = times.drawing;
  const std::size_t fits = levelThatFits(level, wall, until - clock_.now());
  times.gave_way = fits != level;
  if (times.gave_way) {
    views_.clear();
    for (const std::size_t i : operators_) views_.push_back(viewOf(i, T_eye_model));
    chooseCut(fits, views_);
  }
  for (std::size_t k = 0; k < operators_.size(); ++k)
    drawTile(operators_[k], times.gave_way ? k : operators_[k], T_eye_model, times);
  if (times.gave_way) {
    times.drawing = wall + std::chrono::duration_cast<Duration>(wall * operator_share_);
  } else {
    learnOperatorShare(wall, times.drawing - wall);
  }
  return times;
}

// The operator's views cost operator_share_ of what the wall's tiles cost now; half as many
// triangles cost more than half as much.
std::size_t Picture::levelThatFits(std::size_t level, Duration wall, Duration left) const {
  const double share = toSeconds(left) / std::max(operator_share_ * toSeconds(wall), 1e-9);
  if (share >= 1) return level;
  const double triangles = std::pow(std::max(share, 0.0), 1 / kCostExponent) *
                           static_cast<double>(model_.trianglesAt(level));
  return std::max(level,
                  model_.levelFor(std::max(static_cast<std::size_t>(triangles), kLeastOperator)));
}

void Picture::learnOperatorShare(Duration wall, Duration operators) {
  constexpr double kGain = 0.2;
  if (wall > Duration::zero())
    operator_share_ += kGain * (toSeconds(operators) / toSeconds(wall) - operator_share_);
}

void Picture::warmUp(const Eigen::Isometry3f& T_eye_model) {
  draw(T_eye_model, model_.levelFor(kSlice), Timestamp::max());
  beginRefining(T_eye_model);
  refine(clock_.now() + 2 * slice_time_);
}

void Picture::beginRefining(const Eigen::Isometry3f& T_eye_model) {
  beginRefiningTo(T_eye_model, 0);
}

bool Picture::beginRefiningTo(const Eigen::Isometry3f& T_eye_model, std::size_t level) {
  refined_view_ = T_eye_model;
  refined_tile_ = 0;
  refined_begun_ = false;
  viewAll(T_eye_model);
  steps_.clear();
  chooseCut(level, views_);
  return true;
}

// The steps of beginning to refine count for the first slice.
bool Picture::refine(Timestamp until) {
  if (refined_begun_ || refined_tile_ > 0) steps_.clear();
  const Timestamp first = clock_.now();
  bool whole = false;
  for (Timestamp now = first; !whole && now + slice_time_ * 3 / 2 < until;) {
    if (!refined_begun_) {
      beginTile(refined_tile_, refined_view_, 1);
      chooseRuns(refined_tile_);
      refined_ = {};
      refined_begun_ = true;
    }
    drawSlice(refined_);
    renderer_->finish();
    if (refined_.run == runs_.size()) {
      readTile(refined_tile_, 1, refined_pixels_);
      refined_begun_ = false;
      whole = ++refined_tile_ == tiles_.size();
    }
    const Timestamp then = std::exchange(now, clock_.now());
    slice_time_ = std::max<Duration>(now - then, slice_time_ * 9 / 10);
  }
  if (whole) std::swap(pixels_, refined_pixels_);
  // Where slices take longer than a period has, the figure fades until one is tried again.
  if (!whole) slice_time_ = slice_time_ * 9 / 10;
  stepDone(shm::StepKind::kRefine, 0, first);
  return whole;
}

}  // namespace merlin::wall
