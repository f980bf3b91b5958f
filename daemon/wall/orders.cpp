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
  const auto hand = wall ? wall->hand.read() : std::nullopt;
  if (!hand) return;
  // What another wall was asked, or this one before this process began, is past.
  const bool same = generation_ == wall->header.generation;
  if (same && doers_.snapshot && hand->snapshots != seen_.snapshots) doers_.snapshot();
  if (same && doers_.lamp && hand->lamps != seen_.lamps && hand->lamp < kLamps)
    doers_.lamp(nameOf(static_cast<Action>(kFirstLamp + hand->lamp)));
  generation_ = wall->header.generation;
  seen_ = *hand;
}

}  // namespace merlin::wall
