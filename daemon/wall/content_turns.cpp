#include "daemon/wall/content_turns.h"

#include <algorithm>
#include <utility>

namespace merlin::wall {

ContentTurns::ContentTurns(std::vector<ShownContent> contents, render::governor::Governor& governor,
                           ContentSource* source, std::size_t listed)
    : contents_(std::move(contents)),
      governor_(governor),
      initial_(contents_.size()),
      source_(source),
      listed_(listed == 0 ? contents_.size() : listed) {}

render::frame::DrawTimes ContentTurns::draw(std::size_t step,
                                            const Eigen::Isometry3f& T_eye_content) const {
  return painter().draw({T_eye_content, step, Timestamp::max(), governor_.exponent()});
}

void ContentTurns::calibrate(const Eigen::Isometry3f& T_eye_content) {
  std::vector<render::governor::FrameCost> costs;
  const auto fits = [&] { return costs.empty() || costs.back().work <= governor_.period(); };
  index_ = 0;
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
  initial_[0] = {cost, governor_.predict(cost) - governor_.fixedSeconds()};
  for (index_ = 1; index_ < listed_; ++index_) {
    if (source_) source_->prepare(index_);
    measureInitialView(T_eye_content);
  }
  index_ = 0;
  if (source_ && listed_ > 1) source_->prepare(0);
}

// Draws at a cost close to that of the first content's initial view. The fastest of three draws
// counts, since the first one fills caches.
void ContentTurns::measureInitialView(const Eigen::Isometry3f& T_eye_content) {
  const std::size_t step = detail().stepWithin(initial_[0].cost);
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
    const bool stays = asked_ == index_ && source_ && source_->nextWithin(asked_);
    if (!stays) requestPlaceAfter({});
  }
}

void ContentTurns::requestPlaceAfter(std::span<const std::size_t> places) {
  if (places.empty()) {
    in_turn_ = (in_turn_ + 1) % listed_;
    asked_ = in_turn_;
    return;
  }
  const auto at = std::ranges::find(places, asked_);
  request(at == places.end() || at + 1 == places.end() ? places.front() : *(at + 1));
}

bool ContentTurns::leave(std::size_t place, std::span<const std::size_t> places) {
  if (asked_ != place || index_ != place) return false;
  requestPlaceAfter(places);
  return asked_ != place;
}

bool ContentTurns::isOf(std::span<const std::size_t> places) const {
  if (places.empty()) return asked_ < listed_;
  return std::ranges::find(places, asked_) != places.end();
}

void ContentTurns::requestNextOf(std::span<const std::size_t> places) {
  if (places.empty()) return requestNext(1);
  const bool listed = isOf(places);
  if (listed && asked_ == index_ && source_ && source_->nextWithin(asked_)) return;
  requestPlaceAfter(places);
}

void ContentTurns::request(std::size_t place) noexcept {
  if (place >= contents_.size()) return;
  asked_ = place;
  if (place < listed_) in_turn_ = place;
}

bool ContentTurns::showRequested() {
  if (std::exchange(index_, asked_) == asked_) return false;
  if (source_) source_->prepare(index_);
  expectInitialView();
  return true;
}

// The cost of the new content's initial view is not known; the governor learns it while the content
// is shown.
bool ContentTurns::replace(const ContentSource::Replacement& fresh) {
  contents_[fresh.place] = fresh.content;
  fresh.content.painter->setSizeDivisor(size_divisor_);
  initial_[fresh.place].drawing_s = 0;
  return fresh.place == index_;
}

void ContentTurns::setSizeDivisor(int divisor) {
  size_divisor_ = divisor;
  for (const ShownContent& content : contents_) content.painter->setSizeDivisor(divisor);
}

}  // namespace merlin::wall
