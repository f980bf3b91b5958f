#include "render/frame/frame_renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace merlin::render::frame {
namespace {

// warmUp() draws the finest step whose cost is at most this many times leastUseful().
constexpr std::size_t kWarmUp = 32;
// Weight of errors in the operator's view: it shows positions, while the wall shows details.
constexpr float kOperatorWeight = 0.1F;

}  // namespace

Result<std::unique_ptr<FrameRenderer>> FrameRenderer::make(
    std::unique_ptr<content::Content> content, const tiles::TilePlan& plan,
    std::shared_ptr<const DrawContexts> contexts, const Clock& clock) {
  std::unique_ptr<FrameRenderer> made(
      new FrameRenderer(std::move(content), plan, std::move(contexts), clock));
  const auto painterIn = [&](const gl::GlContext& context) {
    return TilePainter::make(context, *made->content_, plan, clock, made->contexts_->asynchronous);
  };
  // Both painters are created at the same time, each on the thread of its context.
  DrawThread* const other = made->contexts_->other.get();
  Result<std::unique_ptr<TilePainter>> others = std::unique_ptr<TilePainter>();
  const std::function<void()> makeOthers = [&] { others = painterIn(other->context()); };
  if (other) other->start(makeOthers);
  auto own = painterIn(*made->contexts_->own);
  if (other) other->wait();
  if (others) made->other_ = *std::move(others);
  if (own) made->painter_ = *std::move(own);
  made->content_->attached();
  if (!own) return own.error();
  if (!others) return others.error();
  return made;
}

FrameRenderer::FrameRenderer(std::unique_ptr<content::Content> content, const tiles::TilePlan& plan,
                             std::shared_ptr<const DrawContexts> contexts, const Clock& clock)
    : content_(std::move(content)),
      plan_(plan),
      clock_(clock),
      contexts_(std::move(contexts)),
      pixels_(std::size_t{4} * static_cast<std::size_t>(plan.frame_width) *
              static_cast<std::size_t>(plan.frame_height)),
      refined_pixels_(pixels_.size()) {
  for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
    all_.push_back(i);
    (isOperators(i) ? operators_ : wall_first_).push_back(i);
  }
  wall_first_.insert(wall_first_.end(), operators_.begin(), operators_.end());
}

// A TilePainter must be destroyed on the thread of its context.
FrameRenderer::~FrameRenderer() {
  if (other_) contexts_->other->run([this] { other_.reset(); });
}

content::ContentView FrameRenderer::viewOf(std::size_t tile,
                                           const Eigen::Isometry3f& T_eye_content) const {
  const tiles::Tile& t = plan_.tiles[tile];
  const tiles::TileMatrices matrices =
      content_->navigation() == content::Navigation::kPanorama
          ? tiles::panoramaMatrices(t)
          : tiles::matricesOf(t, T_eye_content.translation(), content_->bounds().radius_m);
  // The light is at the eye for every tile that follows the wall, so that a surface is equally
  // bright on both sides of a seam. A camera of its own has its light at the camera.
  Eigen::Matrix3f eye_from_content = T_eye_content.linear();
  if (t.camera != tiles::TileCamera::kWall)
    eye_from_content = matrices.view.topLeftCorner<3, 3>() * eye_from_content;
  return {tile,
          matrices.projection * matrices.view * T_eye_content.matrix(),
          eye_from_content,
          t.width,
          t.height,
          isOperators(tile) ? kOperatorWeight : 1};
}

bool FrameRenderer::sees(const Eigen::Isometry3f& T_eye_content) const {
  return tiles::seesBox(plan_, T_eye_content.matrix() * content_->bounds().T_content_box);
}

void FrameRenderer::choose(const Eigen::Isometry3f& T_eye_content, std::size_t step,
                           std::span<const std::size_t> tiles) {
  const Timestamp began = clock_.now();
  views_.clear();
  for (const std::size_t tile : tiles) views_.push_back(viewOf(tile, T_eye_content));
  content_->choose(step, views_);
  stepDone(FrameStep::Kind::kChoose, began);
}

Timestamp FrameRenderer::stepDone(FrameStep::Kind kind, Timestamp began) {
  const Timestamp ended = clock_.now();
  steps_.push_back({kind, 0, began, ended});
  return ended;
}

void FrameRenderer::takeSteps() {
  for (TilePainter* painter : {painter_.get(), other_.get()}) {
    if (!painter) continue;
    steps_.insert(steps_.end(), painter->steps().begin(), painter->steps().end());
    painter->clearSteps();
  }
}

// Sorts the tiles by their times in the last frame, longest first: if a thread took the slowest
// tile last, the other thread would wait for it. The operator's tiles stay last.
void FrameRenderer::sortLongestFirst() {
  std::vector<Duration> took(all_.size());
  for (const FrameStep& step : steps_) {
    if (step.kind == FrameStep::Kind::kDraw) took[step.tile] = step.end - step.begin;
  }
  std::stable_sort(wall_first_.begin(), wall_first_.end(), [&](std::size_t a, std::size_t b) {
    return isOperators(a) != isOperators(b) ? isOperators(b) : took[a] > took[b];
  });
}

void FrameRenderer::onEach(const std::function<void(TilePainter&, std::size_t)>& work) {
  const std::function<void()> others = [&] { work(*other_, 1); };
  if (other_) contexts_->other->start(others);
  work(*painter_, 0);
  if (other_) contexts_->other->wait();
}

DrawTimes FrameRenderer::draw(const Request& asked) {
  Request request = asked;
  steps_.clear();
  const Timestamp began = clock_.now();
  content_->setMoving(true);
  choose(request.T_eye_content, request.step, all_);
  const Duration chosen = clock_.now() - began;
  if (operators_.empty() || operators_.size() == all_.size()) request.until = Timestamp::max();
  TileTimes drawn = drawTiles(request);
  DrawTimes& times = drawn.times;
  const Duration elapsed = clock_.now() - began - chosen;
  const Duration wall = times.drawing - drawn.operators;
  times.gave_way = drawn.gave_way;
  if (drawn.gave_way)
    times.drawing = wall + std::chrono::duration_cast<Duration>(wall * operator_share_);
  else
    learnOperatorShare(wall, drawn.operators);
  // The times of two threads add up to more than the elapsed time, so they are scaled down to it.
  const double sum = toSeconds(wall + drawn.operators + times.fixed);
  const double share = other_ && sum > 0 ? std::min(1.0, toSeconds(elapsed) / sum) : 1;
  times.drawing = chosen + fromSeconds(share * toSeconds(times.drawing));
  times.fixed = fromSeconds(share * toSeconds(times.fixed));
  takeSteps();
  if (other_) sortLongestFirst();
  if (drawn.gave_way) {
    drawOperators(request.T_eye_content, operatorStep(request, wall, request.until - clock_.now()),
                  times);
  }
  takeSteps();
  return times;
}

// Draws the wall's tiles first, then the operator's.
FrameRenderer::TileTimes FrameRenderer::drawTiles(const Request& request) {
  queue_.begin(wall_first_);
  TileTimes each[2];
  onEach([&](TilePainter& painter, std::size_t i) {
    const Timestamp began = clock_.now();
    painter.begin();
    each[i].times.drawing += clock_.now() - began;
    drawFrom(painter, request, each[i]);
    painter.finish(pixels_, each[i].times);
  });
  TileTimes all = each[0];
  all.times.drawing += each[1].times.drawing;
  all.times.fixed += each[1].times.fixed;
  all.operators += each[1].operators;
  all.gave_way |= each[1].gave_way;
  return all;
}

void FrameRenderer::drawFrom(TilePainter& painter, const Request& request, TileTimes& drawn) {
  for (std::size_t tile; (tile = queue_.take()) != TileQueue::kNone;) {
    const bool operators = isOperators(tile);
    const bool may_give_way = operators && operators_.size() < all_.size();
    if (may_give_way) painter.awaitDrawn(drawn.times);
    const Duration before = drawn.times.drawing;
    if (may_give_way) {
      // Extrapolates the time of all wall tiles from those that this thread has drawn.
      const Duration wall = before * static_cast<std::int64_t>(all_.size() - operators_.size()) /
                            static_cast<std::int64_t>(std::max<std::size_t>(drawn.wall_tiles, 1));
      if (operatorStep(request, wall, request.until - clock_.now()) != request.step) {
        drawn.gave_way = true;
        continue;
      }
    }
    painter.draw(tile, size_divisor_, pixels_, drawn.times);
    if (may_give_way) painter.awaitDrawn(drawn.times);
    if (operators)
      drawn.operators += drawn.times.drawing - before;
    else
      ++drawn.wall_tiles;
  }
}

// Draws the operator's views at the level of detail `step`, which operatorStep() chooses by the
// time that is left for the frame.
void FrameRenderer::drawOperators(const Eigen::Isometry3f& T_eye_content, std::size_t step,
                                  DrawTimes& times) {
  choose(T_eye_content, step, operators_);
  painter_->begin();
  DrawTimes theirs;
  for (const std::size_t tile : operators_) painter_->draw(tile, size_divisor_, pixels_, theirs);
  painter_->finish(pixels_, theirs);
  times.fixed += theirs.fixed;
}

// Returns the step at which the operator's views can be drawn within `left`. At the wall's step
// they would take operator_share_ times the wall tiles' time in this frame.
std::size_t FrameRenderer::operatorStep(const Request& request, Duration wall,
                                        Duration left) const {
  const double share = toSeconds(left) / std::max(operator_share_ * toSeconds(wall), 1e-9);
  if (share >= 1) return request.step;
  const content::DetailAxis& detail = content_->detail();
  const double cost = std::pow(std::max(share, 0.0), 1 / request.cost_exponent) *
                      static_cast<double>(detail.costOf(request.step));
  return std::max(request.step, detail.stepWithin(std::max(static_cast<std::size_t>(cost),
                                                           detail.leastUseful())));
}

void FrameRenderer::learnOperatorShare(Duration wall, Duration operators) {
  constexpr double kGain = 0.2;
  if (wall > Duration::zero())
    operator_share_ += kGain * (toSeconds(operators) / toSeconds(wall) - operator_share_);
}

void FrameRenderer::warmUp(const Eigen::Isometry3f& T_eye_content) {
  const content::DetailAxis& detail = content_->detail();
  const std::size_t step = detail.stepWithin(kWarmUp * detail.leastUseful());
  for (const bool by_other : {false, true}) {  // each painter draws all tiles
    if (by_other && !other_) break;
    choose(T_eye_content, step, all_);
    const std::function<void()> work = [&] {
      TilePainter& painter = by_other ? *other_ : *painter_;
      DrawTimes times;
      painter.begin();
      for (const std::size_t tile : all_) painter.draw(tile, size_divisor_, pixels_, times);
      painter.finish(pixels_, times);
    };
    if (by_other)
      contexts_->other->run(work);
    else
      work();
  }
  takeSteps();
  beginRefining(T_eye_content, 0);
  refine(clock_.now() + 2 * painter_->sliceTime());
}

void FrameRenderer::beginRefining(const Eigen::Isometry3f& T_eye_content, std::size_t step) {
  steps_.clear();
  content_->setMoving(false);
  choose(T_eye_content, step, all_);
  queue_.begin(all_);
  refining_begins_ = true;
}

// The steps_ that beginRefining() recorded are kept with those of the first slice.
bool FrameRenderer::refine(Timestamp until) {
  if (!refining_begins_) steps_.clear();
  const Timestamp first = clock_.now();
  onEach([&](TilePainter& painter, std::size_t) {
    if (refining_begins_) painter.begin();
    painter.refine(queue_, refined_pixels_, until);
  });
  refining_begins_ = false;
  const bool whole = queue_.allDone();
  if (whole) std::swap(pixels_, refined_pixels_);
  takeSteps();
  stepDone(FrameStep::Kind::kRefine, first);
  return whole;
}

}  // namespace merlin::render::frame
