#include "daemon/wall/content_turns.h"

#include <algorithm>
#include <utility>

namespace merlin::wall {
namespace {

// Returns the index of `place` in `places`; the last index if it is not there, so that the first
// place follows.
std::size_t turnOf(std::size_t place, std::span<const std::size_t> places) {
  const auto at = std::ranges::find(places, place);
  return at == places.end() ? places.size() - 1 : static_cast<std::size_t>(at - places.begin());
}

}  // namespace

ContentTurns::ContentTurns(std::vector<ShownContent> contents, render::governor::Governor& governor,
                           ContentSource* source, std::size_t listed)
    : contents_(std::move(contents)),
      governor_(governor),
      initial_(contents_.size()),
      source_(source),
      listed_(listed == 0 ? contents_.size() : listed),
      index_(firstThere()),
      asked_(index_),
      in_turn_(index_) {}

render::frame::DrawTimes ContentTurns::draw(std::size_t step,
                                            const Eigen::Isometry3f& T_eye_content) const {
  return painter().draw({T_eye_content, step, Timestamp::max(), governor_.exponent()});
}

void ContentTurns::calibrate(const Eigen::Isometry3f& T_eye_content) {
  std::vector<render::governor::FrameCost> costs;
  const auto fits = [&] { return costs.empty() || costs.back().work <= governor_.period(); };
  const std::size_t first = firstThere();
  index_ = first;
  if (source_) source_->prepare(first);
  std::size_t last = detail().steps();
  for (std::size_t cost = detail().leastUseful() * 10 / 3; fits(); cost *= 4) {
    const std::size_t step = detail().stepWithin(cost);
    if (std::exchange(last, step) == step) break;
    for (int i = 0; i < 3 && fits(); ++i) {
      const render::frame::DrawTimes t = draw(step, T_eye_content);
      costs.push_back({detail().costOf(step), t.fixed, t.fixed + t.drawing, false});
    }
    if (step == 0) break;
  }
  governor_.calibrate(costs);
  const std::size_t cost = governor_.budget();
  initial_[first] = {cost, governor_.predict(cost) - governor_.fixedSeconds()};
  for (index_ = first + 1; index_ < listed_; ++index_) {
    if (shown().missing) continue;
    if (source_) source_->prepare(index_);
    measureInitialView(T_eye_content, cost);
  }
  index_ = first;
  if (source_ && listed_ > 1) source_->prepare(first);
}

// Returns the first place of the list whose content is not missing; 0 if all are missing.
std::size_t ContentTurns::firstThere() const noexcept {
  for (std::size_t place = 0; place < listed_; ++place) {
    if (!contents_[place].missing) return place;
  }
  return 0;
}

// Measures the time that drawing the initial view of content index_ takes, at a cost close to
// `cost`. The shortest of three times is used, since the first one includes filling the caches.
void ContentTurns::measureInitialView(const Eigen::Isometry3f& T_eye_content, std::size_t cost) {
  const std::size_t step = detail().stepWithin(cost);
  InitialView& view = initial_[index_];
  view.cost = detail().costOf(step);
  for (int i = 0; i < 3; ++i) {
    const double s = toSeconds(draw(step, T_eye_content).drawing);
    view.drawing_s = i == 0 ? s : std::min(view.drawing_s, s);
  }
}

void ContentTurns::expectInitialView() const {
  if (size_divisor_ > 1) return;
  const InitialView& view = initial_[index_];
  const double now_s = governor_.predict(view.cost) - governor_.fixedSeconds();
  if (view.drawing_s > 0 && now_s > 0) governor_.expect(view.drawing_s / now_s);
}

void ContentTurns::requestNext(std::uint32_t times) {
  for (std::uint32_t i = 0; i < times; ++i) {
    back_ = false;
    if (!isShownNow() || !source_->nextWithin(asked_)) requestPlaceAfter({});
    chosen_ = true;
  }
}

void ContentTurns::requestPrevious(std::uint32_t times) {
  for (std::uint32_t i = 0; i < times; ++i) {
    back_ = true;
    if (!isShownNow() || !source_->previousWithin(asked_)) requestPlaceBefore();
    chosen_ = true;
  }
}

void ContentTurns::requestPlaceAfter(std::span<const std::size_t> places) {
  const std::size_t count = places.empty() ? listed_ : places.size();
  std::size_t turn = places.empty() ? in_turn_ : turnOf(asked_, places);
  for (std::size_t tried = 0; tried < count; ++tried) {
    turn = (turn + 1) % count;
    const std::size_t place = places.empty() ? turn : places[turn];
    if (!contents_[place].missing) return request(place);
  }
}

void ContentTurns::requestPlaceBefore() {
  std::size_t turn = asked_ < listed_ ? in_turn_ : in_turn_ + 1;
  for (std::size_t tried = 0; tried < listed_; ++tried) {
    turn = (turn + listed_ - 1) % listed_;
    if (!contents_[turn].missing) return request(turn);
  }
}

bool ContentTurns::leave(std::size_t place, std::span<const std::size_t> places) {
  if (asked_ != place || index_ != place) return false;
  const bool chosen = chosen_;
  if (back_)
    requestPlaceBefore();
  else
    requestPlaceAfter(places);
  chosen_ = chosen;
  return asked_ != place;
}

bool ContentTurns::belongsTo(std::span<const std::size_t> places) const {
  if (chosen_) return true;
  if (places.empty()) return asked_ < listed_;
  return std::ranges::find(places, asked_) != places.end();
}

void ContentTurns::requestNextOf(std::span<const std::size_t> places) {
  back_ = false;
  if (belongsTo(places) && isShownNow() && source_->nextWithin(asked_)) return;
  requestPlaceAfter(places);
}

void ContentTurns::choose(std::size_t place) noexcept {
  request(place);
  if (asked_ == place) chosen_ = true;
}

// A request for the place that is already requested, for example because of its next slide, does
// not reset chosen_.
void ContentTurns::request(std::size_t place) noexcept {
  if (place >= contents_.size() || contents_[place].missing) return;
  if (std::exchange(asked_, place) != place) chosen_ = false;
  if (place < listed_) in_turn_ = place;
}

bool ContentTurns::showRequested() {
  if (std::exchange(index_, asked_) == asked_) return false;
  if (source_) source_->prepare(index_);
  expectInitialView();
  return true;
}

// The drawing time of the new content's initial view is not known; the governor learns it while the
// content is shown.
bool ContentTurns::replace(const ContentSource::Replacement& fresh) {
  const bool nothing_shown = contents_[asked_].missing;
  contents_[fresh.place] = fresh.content;
  if (nothing_shown) request(fresh.place);
  fresh.content.painter->setSizeDivisor(size_divisor_);
  initial_[fresh.place].drawing_s = 0;
  return fresh.place == index_;
}

void ContentTurns::setSizeDivisor(int divisor) {
  size_divisor_ = divisor;
  for (const ShownContent& content : contents_) content.painter->setSizeDivisor(divisor);
}

}  // namespace merlin::wall
