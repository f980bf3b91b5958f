#include "daemon/wall/viewer_place.h"

#include <utility>

#include <fmt/format.h>

namespace merlin::wall {

ViewerPlace::ViewerPlace(render::stereo::Head head, int station, render::tiles::TilePlan& plan,
                         std::function<void(Event)> report)
    : head_(std::move(head)), station_(station), plan_(plan), report_(std::move(report)) {}

bool ViewerPlace::update(const std::optional<TrackerSample>& sample, Timestamp now) {
  const auto view = head_.update(sample, now);
  reportTracking(view.tracked, now);
  if (!view.moving) return false;
  const bool placed = render::tiles::placeViewer(plan_, view.viewer);
  if (std::exchange(is_placed_, placed) && !placed) {
    report_(faultEvent(
        fmt::format("tracker station {} says that the viewer's eyes are on or behind a screen, or "
                    "almost touch one: the wall is drawn for their position before that",
                    station_)));
  }
  return true;
}

void ViewerPlace::reportTracking(bool tracked, Timestamp now) {
  if (!began_) began_ = now;
  const bool waits = !tracked_ && !tracked && now - *began_ < kPatience;
  if (waits || tracked_ == tracked) return;
  tracked_ = tracked;
  report_(tracked ? newsEvent(fmt::format(
                        "the wall is drawn for the viewer's head, tracker station {}", station_))
                  : faultEvent(fmt::format("tracker station {} on the viewer's head is missing: "
                                           "the wall is drawn for the configured place of the "
                                           "viewer",
                                           station_)));
}

}  // namespace merlin::wall
