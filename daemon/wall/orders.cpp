#include "daemon/wall/orders.h"

#include <iterator>

namespace merlin::wall {

void Orders::poll(Timestamp now) {
  constexpr const char* kLamps[] = {"lamp_off", "lamp_slow", "lamp_fast", "lamp_on"};
  const shm::WallSegment* wall = wall_.get(now);
  const auto hand = wall ? wall->hand.read() : std::nullopt;
  if (!hand) return;
  // What another wall was asked, or this one before this process began, is past.
  const bool same = generation_ == wall->header.generation;
  if (same && doers_.snapshot && hand->snapshots != seen_.snapshots) doers_.snapshot();
  if (same && doers_.lamp && hand->lamps != seen_.lamps && hand->lamp < std::size(kLamps))
    doers_.lamp(kLamps[hand->lamp]);
  generation_ = wall->header.generation;
  seen_ = *hand;
}

}  // namespace merlin::wall
