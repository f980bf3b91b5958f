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
    Correction* const correction = corrections_[i].get();
    const bool watched = isWatched(i);
    out::Signal signal = meant;
    if (correction)
      signal = watched || outputs_.mayTake(i, info) ? correction->apply(meant) : out::Signal{};
    outputs_.present(i, signal, info, deadline);
    if (watched) watcher_->see(i, signal, info);
  }
  for (auto overlay = overlays_.rbegin(); overlay != overlays_.rend(); ++overlay)
    (*overlay)->erase(canvas);
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
