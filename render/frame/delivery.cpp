#include "render/frame/delivery.h"

#include <algorithm>
#include <ranges>
#include <utility>

namespace merlin::render {

Delivery::Delivery(const TilePlan& plan, OutputSet& outputs, std::vector<Overlay*> overlays,
                   std::vector<std::unique_ptr<Correction>> corrections)
    : plan_(plan),
      outputs_(outputs),
      overlays_(std::move(overlays)),
      corrections_(std::move(corrections)) {
  corrections_.resize(outputs_.size());
}

void Delivery::show(std::span<std::uint8_t> canvas, const FrameInfo& info,
                    std::optional<Timestamp> deadline) {
  for (Overlay* overlay : overlays_) overlay->draw(canvas);
  const Signal meant{plan_.frame_width, plan_.frame_height, canvas};
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    Correction* const correction = corrections_[i].get();
    outputs_.present(i, correction ? correction->apply(meant) : meant, info, deadline);
  }
  for (Overlay* overlay : std::views::reverse(overlays_)) overlay->erase(canvas);
}

bool Delivery::overlaysHaveChanged() const {
  return std::ranges::any_of(overlays_, &Overlay::hasChanged);
}

}  // namespace merlin::render
