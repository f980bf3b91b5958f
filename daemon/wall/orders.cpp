#include "daemon/wall/orders.h"

#include "render/scene/settings.h"

namespace merlin::wall {
namespace {

using render::Action;

// The lamp's actions, in the order of GpioSample::Lamp, have the names of the panel's commands.
constexpr auto kFirstLamp = static_cast<std::uint32_t>(Action::kLampOff);
constexpr auto kLamps = static_cast<std::uint32_t>(Action::kLampOn) - kFirstLamp + 1;

}  // namespace

void Orders::poll(Timestamp now) {
  const shm::WallSegment* wall = wall_.get(now);
  const auto interaction = wall ? wall->interaction.read() : std::nullopt;
  if (!interaction) return;
  // What another wall was asked, or this one before this process began, is past.
  const bool same = generation_ == wall->header.generation;
  if (same && doers_.snapshot && interaction->snapshots != seen_.snapshots) doers_.snapshot();
  if (same && doers_.lamp && interaction->lamps != seen_.lamps && interaction->lamp < kLamps)
    doers_.lamp(nameOf(static_cast<Action>(kFirstLamp + interaction->lamp)));
  generation_ = wall->header.generation;
  seen_ = *interaction;
}

}  // namespace merlin::wall
