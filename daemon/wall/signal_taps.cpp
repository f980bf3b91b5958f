#include "daemon/wall/signal_taps.h"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/printable_text.h"
#include "daemon/shm/segment.h"

namespace merlin::wall {
namespace {

constexpr Duration kKept = std::chrono::seconds(60);

}  // namespace

SignalTaps::SignalTaps(const std::string& instance, std::vector<TappedOutput> outputs,
                       std::uint64_t generation, const Clock& clock)
    : generation_(generation), clock_(clock) {
  for (TappedOutput& output : outputs) {
    auto tap = std::make_unique<Tap>();
    tap->segment = fmt::format("{}-{}", shm::segmentName(instance, "signal"), taps_.size());
    tap->output = std::move(output);
    taps_.push_back(std::move(tap));
  }
}

Result<std::string> SignalTaps::ask(const std::string& output) {
  std::vector<std::string> names;
  for (const auto& tap : taps_) {
    names.push_back(tap->output.name);
    if (tap->output.name != output) continue;
    const std::lock_guard lock(tap->mutex);
    tap->asked = clock_.now();
    if (!tap->memory) {
      render::tiles::TilePlan plan;
      plan.frame_width = tap->output.width;
      plan.frame_height = tap->output.height;
      auto made = render::out::SharedFrameOutput::make(tap->segment, plan, generation_, clock_);
      if (!made) return made.error();
      tap->memory = *std::move(made);
    }
    tap->wanted = true;
    return tap->segment;
  }
  return Error{Errc::kInvalidArgument,
               fmt::format("there is no output \"{}\"; the outputs of this wall are {}",
                           excerpt(output), fmt::join(names, ", "))};
}

void SignalTaps::tend(Timestamp now) {
  for (const auto& tap : taps_) {
    const std::lock_guard lock(tap->mutex);
    if (!tap->memory || now - tap->asked < kKept) continue;
    tap->wanted = false;
    tap->memory.reset();
  }
}

void SignalTaps::see(std::size_t i, const render::out::Signal& signal,
                     const render::out::FrameInfo& info) {
  Tap& tap = *taps_[i];
  const std::unique_lock lock(tap.mutex, std::try_to_lock);
  if (!lock || !tap.memory) return;
  tap.wanted = false;
  if (signal.width != tap.output.width || signal.height != tap.output.height) return;
  static_cast<void>(tap.memory->present(signal, info));  // present() never fails
}

}  // namespace merlin::wall
