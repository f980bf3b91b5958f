#include "daemon/devices/wall_fault.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "daemon/base/fixed_text.h"

namespace merlin::devices {
namespace {

constexpr std::uint32_t kAsMeant = 1;  // OutputStats::picture: it shows what it was sent

}  // namespace

std::string faultAmong(const shm::WallOutputs& outputs) {
  const auto count = std::min<std::size_t>(outputs.count, std::size(outputs.outputs));
  for (std::size_t i = 0; i < count; ++i) {
    const shm::OutputStats& output = outputs.outputs[i];
    if (output.failed == 0 && output.picture <= kAsMeant) continue;
    return fmt::format("output {}: {}", textIn(output.name),
                       output.failed != 0 ? textIn(output.fault) : textIn(output.picture_fault));
  }
  return {};
}

std::string WallFault::look(Timestamp now) {
  const shm::WallSegment* const segment = wall_.get(now);
  if (segment) {
    seen_ = now;
    const auto outputs = segment->outputs.read();
    return outputs ? faultAmong(*outputs) : std::string();
  }
  if (!seen_ || now - *seen_ < kGone) return {};
  return fmt::format("the role wall has not run for {:.0f} s", toSeconds(kGone));
}

}  // namespace merlin::devices
