#include "daemon/status/wall_events.h"

#include <utility>

#include <fmt/format.h>

namespace merlin::status {

std::vector<std::string> WallEvents::take() {
  std::vector<std::string> events;
  const auto s = segment_.stats.read();
  if (!s) return events;
  if (const auto was = std::exchange(operator_coarser_, s->operator_coarser);
      was != operator_coarser_) {
    events.push_back(operator_coarser_ != 0
                         ? "the operator's view is coarser: there is too little time"
                         : "the operator's view is as fine as the wall again");
  }
  if (const auto was = std::exchange(scale_, s->scale_divisor); was != scale_) {
    events.push_back(scale_ > 1 ? "tiles at half size while moving: even the fewest triangles take "
                                  "too long"
                                : "tiles at full size again: the fewest triangles fit");
  }
  if (const auto was = std::exchange(divisor_, s->rate_divisor); was != divisor_) {
    events.push_back(
        was < divisor_
            ? fmt::format("rate reduced to {:.3g} of {:.3g} Hz: even the fewest triangles "
                          "take too long",
                          s->rate_now_hz, s->rate_asked_hz)
            : fmt::format("rate raised to {:.3g} of {:.3g} Hz: the fewest triangles fit",
                          s->rate_now_hz, s->rate_asked_hz));
  }
  if (const auto was = std::exchange(held_, s->held_triangles); was != held_) {
    events.push_back(held_ != 0 ? fmt::format("{} triangles while moving, set by hand", held_)
                                : "number of triangles chosen by the governor again");
  }
  if (const auto was = std::exchange(asked_hz_, s->rate_asked_hz); was != asked_hz_ && was != 0)
    events.push_back(fmt::format("the desired rate is {:.3g} Hz now", asked_hz_));
  if (const auto was = std::exchange(returned_, s->returned); was != returned_)
    events.push_back("the start view has returned: no tile of the wall showed any of the content");
  return events;
}

}  // namespace merlin::status
