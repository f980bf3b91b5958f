#include "daemon/status/wall_events.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/fixed_text.h"

namespace merlin::status {

std::vector<Event> WallEvents::take() {
  std::vector<Event> events;
  const auto s = segment_.stats.read();
  if (!s) return events;
  // A reduction of detail or rate is not a fault: the wall adapts by design.
  if (const auto was = std::exchange(operator_coarser_, s->operator_coarser);
      was != operator_coarser_) {
    events.push_back(operator_coarser_ != 0
                         ? newsEvent("the operator's view is coarser: there is too little time")
                         : newsEvent("the operator's view is as fine as the wall again"));
  }
  if (const auto was = std::exchange(scale_, s->scale_divisor); was != scale_) {
    events.push_back(
        scale_ > 1 ? newsEvent("tiles at half size while moving: even the coarsest level of detail "
                               "takes too long")
                   : newsEvent("tiles at full size again: the coarsest level of detail is fast "
                               "enough"));
  }
  if (const auto was = std::exchange(divisor_, s->rate_divisor); was != divisor_) {
    const float rate_hz = s->rate_asked_hz / static_cast<float>(std::max(divisor_, 1U));
    events.push_back(
        was < divisor_
            ? newsEvent(fmt::format("frame rate reduced to {:.3g} of {:.3g} Hz: even the coarsest "
                                    "level of detail takes too long",
                                    rate_hz, s->rate_asked_hz))
            : newsEvent(fmt::format("frame rate raised to {:.3g} of {:.3g} Hz: the coarsest level "
                                    "of detail is fast enough",
                                    rate_hz, s->rate_asked_hz)));
  }
  if (const auto was = std::exchange(held_, s->held_cost); was != held_) {
    events.push_back(routineEvent(held_ != 0 ? fmt::format("{} {} while moving, set by hand", held_,
                                                           std::string_view(s->cost_unit))
                                             : "detail chosen by the governor again"));
  }
  if (const auto was = std::exchange(asked_hz_, s->rate_asked_hz); was != asked_hz_ && was != 0)
    events.push_back(
        routineEvent(fmt::format("the desired frame rate is {:.3g} Hz now", asked_hz_)));
  if (const auto was = std::exchange(returned_, s->returned); was != returned_)
    events.push_back(
        routineEvent("the start view has returned: no tile of the wall showed any of the content"));
  takeOutputs(events);
  return events;
}

void WallEvents::takeOutputs(std::vector<Event>& events) {
  const auto all = segment_.outputs.read();
  if (!all) return;
  const std::size_t count = std::min<std::size_t>(all->count, std::size(all->outputs));
  faults_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const shm::OutputStats& o = all->outputs[i];
    std::string fault(textIn(o.fault));
    if (fault == faults_[i]) continue;
    const std::string_view name = textIn(o.name);
    events.push_back(fault.empty() ? newsEvent(fmt::format("output {} works again", name))
                                   : faultEvent(fmt::format("output {} failed: {}", name, fault)));
    faults_[i] = std::move(fault);
  }
}

std::vector<Event> WallEvents::takePictures() {
  std::vector<Event> events;
  const auto all = segment_.outputs.read();
  if (!all) return events;
  const std::size_t count = std::min<std::size_t>(all->count, std::size(all->outputs));
  pictures_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const shm::OutputStats& o = all->outputs[i];
    std::string wrong(textIn(o.picture_fault));
    const std::string was = std::exchange(pictures_[i], wrong);
    if (wrong == was) continue;
    const std::string_view name = textIn(o.name);
    if (!wrong.empty())
      events.push_back(faultEvent(fmt::format("output {} {}", name, wrong)));
    else if (o.picture != 0)
      events.push_back(newsEvent(fmt::format("output {} shows what was meant again", name)));
    else
      events.push_back(
          faultEvent(fmt::format("output {} shows no picture that could be read back", name)));
  }
  return events;
}

}  // namespace merlin::status
