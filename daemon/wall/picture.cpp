#include "daemon/wall/picture.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "render/mesh/io/picture_file.h"

namespace merlin::wall {
namespace {

using render::ModelRenderer;

// Of the frame that is drawn once before the first.
constexpr std::size_t kWarmUp = 10'000;

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

Eigen::Matrix4f boxOf(const render::Dendrogram& model, const Eigen::Matrix4f& metres_from_model) {
  const render::Box box = render::boundingBox(model.arrays().positions);
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    m(k, k) = metres_from_model(k, k) * (box.high[i] - box.low[i]) / 2;
  }
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

}  // namespace

Result<std::shared_ptr<DrawContexts>> DrawContexts::make(const render::RenderSettings& settings) {
  auto contexts = std::make_shared<DrawContexts>();
  auto own = render::makeGlContext(settings.backend);
  if (!own) return own.error();
  contexts->own = *std::move(own);
  if (settings.contexts == 1) return contexts;
  const bool software = contexts->own->renderer().find("llvmpipe") != std::string::npos;
  const bool pays = software && std::thread::hardware_concurrency() > 1;
  if (settings.contexts == 0 && !pays) return contexts;
  auto other = settings.backend == render::GlBackend::kEgl
                   ? DrawThread::make()
                   : Error{Errc::kUnsupported,
                           "render.contexts: OSMesa has one for a process; "
                           "set it to 1, or render.backend to egl"};
  if (other)
    contexts->other = *std::move(other);
  else if (settings.contexts > 1)
    return other.error();
  return contexts;
}

std::string DrawContexts::renderer() const {
  return own->renderer() + (other ? ", two contexts" : "");
}

Result<std::unique_ptr<Picture>> Picture::make(const render::Dendrogram& model,
                                               const render::TilePlan& plan,
                                               const render::RenderSettings& settings,
                                               double radius_m, const Clock& clock,
                                               std::shared_ptr<const DrawContexts> contexts) {
  if (!contexts) {
    auto made = DrawContexts::make(settings);
    if (!made) return made.error();
    contexts = *std::move(made);
  }
  auto picture = prepare(model, plan, settings, radius_m, clock);
  if (!picture) return picture.error();
  if (const auto done = (*picture)->upload(std::move(contexts)); !done) return done.error();
  return picture;
}

Result<std::unique_ptr<Picture>> Picture::prepare(const render::Dendrogram& model,
                                                  const render::TilePlan& plan,
                                                  const render::RenderSettings& settings,
                                                  double radius_m, const Clock& clock) {
  std::unique_ptr<Picture> picture(new Picture(model, plan, settings, radius_m, clock));
  auto texture = textureOf(model);
  if (!texture) return texture.error();
  picture->prepared_ = std::make_unique<Prepared>();
  Prepared& prepared = *picture->prepared_;
  prepared.texels = std::move(texture->pixels);
  prepared.texture = {texture->width, texture->height, prepared.texels};
  picture->clusters_.everything(prepared.full, picture->full_ends_);
  return picture;
}

Result<Ok> Picture::upload(std::shared_ptr<const DrawContexts> contexts) {
  contexts_ = std::move(contexts);
  const auto prepared = std::move(prepared_);
  const auto painterIn = [&](const render::GlContext& context) {
    return TilePainter::make(context.gl(), model_, plan_, settings_, prepared->full,
                             prepared->texels.empty() ? nullptr : &prepared->texture, clock_);
  };
  // At once, each on its thread.
  DrawThread* const other = contexts_->other.get();
  Result<std::unique_ptr<TilePainter>> others = std::unique_ptr<TilePainter>();
  const std::function<void()> makeOthers = [&] { others = painterIn(other->context()); };
  if (other) other->start(makeOthers);
  auto own = painterIn(*contexts_->own);
  if (other) other->wait();
  if (others) other_ = *std::move(others);
  if (own) painter_ = *std::move(own);
  if (!own) return own.error();
  if (!others) return others.error();
  return Ok{};
}

Picture::Picture(const render::Dendrogram& model, const render::TilePlan& plan,
                 const render::RenderSettings& settings, double radius_m, const Clock& clock)
    : model_(model),
      plan_(plan),
      settings_(settings),
      radius_m_(static_cast<float>(radius_m)),
      metres_from_model_(scaling(model, radius_m_)),
      T_metres_box_(boxOf(model, metres_from_model_)),
      clock_(clock),
      clusters_(model, {}),
      view_cut_(model, clusters_, settings.look.draw_back_faces),
      cut_ends_(clusters_.size() + 1),
      even_levels_(clusters_.size()),
      pixels_(std::size_t{4} * static_cast<std::size_t>(plan.frame_width) *
              static_cast<std::size_t>(plan.frame_height)),
      refined_pixels_(pixels_.size()) {
  for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
    all_.push_back(i);
    (isOperators(i) ? operators_ : wall_first_).push_back(i);
  }
  wall_first_.insert(wall_first_.end(), operators_.begin(), operators_.end());
  content_.cameras.resize(all_.size());
  content_.runs.resize(all_.size());
}

// Each part where its context is.
Picture::~Picture() {
  if (other_) contexts_->other->run([this] { other_.reset(); });
}

render::Camera Picture::cameraOf(std::size_t tile, const Eigen::Isometry3f& T_eye_model) const {
  const render::Tile& t = plan_.tiles[tile];
  const Eigen::Matrix4f view =
      isOperators(tile) ? render::operatorView(t.projection, T_eye_model.translation(), radius_m_)
                        : t.view;
  // The light comes from the eye, not from the tile: so a surface is as bright on either side of a
  // seam.
  return {t.projection * view * T_eye_model.matrix() * metres_from_model_, T_eye_model.linear()};
}

bool Picture::sees(const Eigen::Isometry3f& T_eye_model) const {
  return render::seesBox(plan_, T_eye_model.matrix() * T_metres_box_);
}

void Picture::chooseCut(const Eigen::Isometry3f& T_eye_model, std::size_t level,
                        std::span<const std::size_t> tiles) {
  const Timestamp began = clock_.now();
  views_.clear();
  for (const std::size_t tile : tiles) {
    content_.cameras[tile] = cameraOf(tile, T_eye_model);
    views_.push_back({content_.cameras[tile].clip_from_model, plan_.tiles[tile].width,
                      isOperators(tile) ? kOperatorWeight : 1});
  }
  const bool uneven =
      level > 0 && settings_.view_dependent && view_cut_.choose(views_, model_.trianglesAt(level));
  if (!uneven) view_cut_.look(views_);
  content_.source = level == 0 ? ModelRenderer::Source::kFull : ModelRenderer::Source::kCut;
  clustered_ = uneven || level == 0 || clusters_.isClustered(level);
  const std::size_t triangles = level == 0 ? 0 : cutTo(level, uneven);
  content_.cut = std::span(cut_).first(3 * triangles);
  if (level == 0) morphs_.clear();
  content_.morphs = morphs_;
  for (std::size_t view = 0; view < tiles.size(); ++view)
    chooseRuns(view, content_.runs[tiles[view]]);
  stepDone(shm::StepKind::kCut, began);
}

// Fills cut_ and morphs_; returns triangles.
std::size_t Picture::cutTo(std::size_t level, bool uneven) {
  const std::size_t budget = model_.trianglesAt(level);
  if (cut_.size() < 3 * budget) cut_.resize(3 * budget);
  if (uneven)
    morphsAt(model_, clusters_, view_cut_.levels(), settings_.geomorph, morphs_);
  else
    morphsAt(model_, level, settings_.geomorph, morphs_);
  if (clustered_ && !uneven)
    std::fill(even_levels_.begin(), even_levels_.end(), static_cast<std::uint32_t>(level));
  const auto levels = uneven ? view_cut_.levels() : std::span<const std::uint32_t>(even_levels_);
  return clustered_ ? clusters_.cut(levels, cut_, cut_ends_) : clusters_.cutEvenly(level, cut_);
}

Timestamp Picture::stepDone(shm::StepKind kind, Timestamp began) {
  const Timestamp ended = clock_.now();
  steps_.push_back({kind, 0, began, ended});
  return ended;
}

void Picture::takeSteps() {
  for (TilePainter* painter : {painter_.get(), other_.get()}) {
    if (!painter) continue;
    steps_.insert(steps_.end(), painter->steps().begin(), painter->steps().end());
    painter->clearSteps();
  }
}

// By the last frame: who takes the longest tile last keeps the other waiting.
void Picture::longestFirst() {
  std::vector<Duration> took(all_.size());
  for (const PaintStep& step : steps_) {
    if (step.kind == shm::StepKind::kDraw) took[step.tile] = step.end - step.begin;
  }
  std::stable_sort(wall_first_.begin(), wall_first_.end(), [&](std::size_t a, std::size_t b) {
    return isOperators(a) != isOperators(b) ? isOperators(b) : took[a] > took[b];
  });
}

// Neighbouring clusters that the view sees are one run.
void Picture::chooseRuns(std::size_t view, std::vector<TriangleRun>& runs) const {
  runs.clear();
  const bool cut = content_.source == ModelRenderer::Source::kCut;
  if (cut && !clustered_) {
    runs.push_back({0, content_.cut.size() / 3});
    return;
  }
  const auto& ends = cut ? cut_ends_ : full_ends_;
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

void Picture::onEach(const std::function<void(TilePainter&, std::size_t)>& work) {
  const std::function<void()> others = [&] { work(*other_, 1); };
  if (other_) contexts_->other->start(others);
  work(*painter_, 0);
  if (other_) contexts_->other->wait();
}

DrawTimes Picture::draw(const Eigen::Isometry3f& T_eye_model, std::size_t level, Timestamp until) {
  steps_.clear();
  const Timestamp began = clock_.now();
  chooseCut(T_eye_model, level, all_);
  const Duration cut = clock_.now() - began;
  if (operators_.empty() || operators_.size() == all_.size()) until = Timestamp::max();
  Drawn drawn = drawTiles(level, until);
  DrawTimes& times = drawn.times;
  const Duration elapsed = clock_.now() - began - cut;
  const Duration wall = times.drawing - drawn.operators;
  times.gave_way = drawn.gave_way;
  if (drawn.gave_way)
    times.drawing = wall + std::chrono::duration_cast<Duration>(wall * operator_share_);
  else
    learnOperatorShare(wall, drawn.operators);
  // Of two threads, what the frame took.
  const double sum = toSeconds(wall + drawn.operators + times.fixed);
  const double share = other_ && sum > 0 ? std::min(1.0, toSeconds(elapsed) / sum) : 1;
  times.drawing = cut + fromSeconds(share * toSeconds(times.drawing));
  times.fixed = fromSeconds(share * toSeconds(times.fixed));
  takeSteps();
  if (other_) longestFirst();
  if (drawn.gave_way)
    drawOperators(T_eye_model, levelThatFits(level, wall, until - clock_.now()), times);
  takeSteps();
  return times;
}

// The wall's tiles first.
Picture::Drawn Picture::drawTiles(std::size_t level, Timestamp until) {
  queue_.begin(wall_first_);
  Drawn each[2];
  onEach([&](TilePainter& painter, std::size_t i) {
    const Timestamp began = clock_.now();
    painter.begin(content_);
    each[i].times.drawing += clock_.now() - began;
    drawFrom(painter, level, until, each[i]);
  });
  Drawn all = each[0];
  all.times.drawing += each[1].times.drawing;
  all.times.fixed += each[1].times.fixed;
  all.operators += each[1].operators;
  all.gave_way |= each[1].gave_way;
  return all;
}

void Picture::drawFrom(TilePainter& painter, std::size_t level, Timestamp until, Drawn& drawn) {
  for (std::size_t tile; (tile = queue_.take()) != TileQueue::kNone;) {
    const Duration before = drawn.times.drawing;
    const bool operators = isOperators(tile);
    if (operators && operators_.size() < all_.size()) {
      // As if all of the wall's tiles took what these took.
      const Duration wall = before * static_cast<std::int64_t>(all_.size() - operators_.size()) /
                            static_cast<std::int64_t>(std::max<std::size_t>(drawn.wall_tiles, 1));
      if (levelThatFits(level, wall, until - clock_.now()) != level) {
        drawn.gave_way = true;
        continue;
      }
    }
    painter.draw(content_, tile, scale_, pixels_, drawn.times);
    if (operators)
      drawn.operators += drawn.times.drawing - before;
    else
      ++drawn.wall_tiles;
  }
}

// Coarser, in what time is left.
void Picture::drawOperators(const Eigen::Isometry3f& T_eye_model, std::size_t level,
                            DrawTimes& times) {
  chooseCut(T_eye_model, level, operators_);
  painter_->begin(content_);
  DrawTimes theirs;
  for (const std::size_t tile : operators_) painter_->draw(content_, tile, scale_, pixels_, theirs);
  times.fixed += theirs.fixed;
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
  const std::size_t level = model_.levelFor(kWarmUp);
  for (const bool by_other : {false, true}) {  // each draws all of it
    if (by_other && !other_) break;
    chooseCut(T_eye_model, level, all_);
    const std::function<void()> work = [&] {
      TilePainter& painter = by_other ? *other_ : *painter_;
      DrawTimes times;
      painter.begin(content_);
      for (const std::size_t tile : all_) painter.draw(content_, tile, scale_, pixels_, times);
    };
    if (by_other)
      contexts_->other->run(work);
    else
      work();
  }
  takeSteps();
  beginRefining(T_eye_model);
  refine(clock_.now() + 2 * painter_->sliceTime());
}

void Picture::beginRefining(const Eigen::Isometry3f& T_eye_model) {
  beginRefiningTo(T_eye_model, 0);
}

bool Picture::beginRefiningTo(const Eigen::Isometry3f& T_eye_model, std::size_t level) {
  steps_.clear();
  chooseCut(T_eye_model, level, all_);
  queue_.begin(all_);
  refining_begins_ = true;
  return true;
}

// The steps of beginning to refine count for the first slice.
bool Picture::refine(Timestamp until) {
  if (!refining_begins_) steps_.clear();
  const Timestamp first = clock_.now();
  onEach([&](TilePainter& painter, std::size_t) {
    if (refining_begins_) painter.begin(content_);
    painter.refine(content_, queue_, refined_pixels_, until);
  });
  refining_begins_ = false;
  const bool whole = queue_.allDone();
  if (whole) std::swap(pixels_, refined_pixels_);
  takeSteps();
  stepDone(shm::StepKind::kRefine, first);
  return whole;
}

}  // namespace merlin::wall
