#include "render/frame/delivery.h"

#include <algorithm>
#include <utility>

namespace merlin::render::frame {

Delivery::Delivery(const tiles::TilePlan& plan, out::OutputSet& outputs,
                   std::vector<Overlay*> overlays,
                   std::vector<std::unique_ptr<Correction>> corrections,
                   frame::SignalWatcher* watcher)
    : plan_(plan),
      outputs_(outputs),
      overlays_(std::move(overlays)),
      corrections_(std::move(corrections)),
      watcher_(watcher) {
  corrections_.resize(outputs_.size());
}

void Delivery::show(std::span<std::uint8_t> canvas, const out::FrameInfo& info,
                    std::optional<Timestamp> deadline) {
  for (Overlay* overlay : overlays_) overlay->draw(canvas);
  const out::Signal meant{plan_.frame_width, plan_.frame_height, canvas};
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const bool watched = isWatched(i);
    const out::Signal signal = signalOf(i, meant, info, watched);
    outputs_.present(i, signal, info, deadline);
    if (watched) watcher_->see(i, signal, info);
  }
  for (auto overlay = overlays_.rbegin(); overlay != overlays_.rend(); ++overlay)
    (*overlay)->erase(canvas);
}

// A signal that is watched is needed in memory, so it is copied.
out::Signal Delivery::signalOf(std::size_t i, const out::Signal& meant, const out::FrameInfo& info,
                               bool watched) {
  Correction* const correction = corrections_[i].get();
  if (!correction) return meant;
  if (watched) return correction->apply(meant);
  if (!outputs_.mayTake(i, info)) return {};
  if (!correction->canDraw()) return correction->apply(meant);
  const std::vector<out::DrawPlace> places = outputs_.beginDrawing(i);
  return places.empty() ? correction->apply(meant) : correction->draw(meant, places);
}

bool Delivery::hasChanged(Timestamp now) const {
  if (std::ranges::any_of(overlays_, &Overlay::hasChanged)) return true;
  for (std::size_t i = 0; i < corrections_.size(); ++i) {
    if (isWatched(i) || outputs_.wantsFrame(i, now)) return true;
    const bool corrected = corrections_[i] && corrections_[i]->hasChanged();
    if (corrected && outputs_.mayTake(i, {.finished = now})) return true;
  }
  return false;
}

}  // namespace merlin::render::frame
