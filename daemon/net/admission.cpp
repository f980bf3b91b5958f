#include "daemon/net/admission.h"

#include <algorithm>
#include <tuple>

namespace merlin::net {
namespace {

bool sameGroup(const Peer& a, const Peer& b) { return a.user == b.user && a.address == b.address; }

bool mayGo(const Occupant& o, const Places& places, Timestamp now) {
  return o.established ? now - o.active >= places.idle : now - o.since >= places.opening;
}

struct Held {
  std::ptrdiff_t group, own;
};

// Numbers of places that are held by the peer's user or address, and by the peer itself.
Held heldBy(const Peer& peer, std::span<const Occupant> all) {
  Held held{};
  for (const Occupant& o : all) {
    held.group += sameGroup(o.peer, peer);
    held.own += o.peer == peer;
  }
  return held;
}

// Order in which connections are closed for a new one: the largest rank first.
auto rank(const Occupant& o, std::span<const Occupant> all, Timestamp now) {
  const Held held = heldBy(o.peer, all);
  return std::tuple(!o.established, held.group, held.own, now - o.active);
}

// Whether `other` would still hold at least as many places as the newcomer after giving it one.
// With a smaller difference two peers could take a place from each other alternately.
bool holdsMore(const Held& other, const Held& newcomer) {
  return other.group > newcomer.group + 1 ||
         (other.group >= newcomer.group && other.own > newcomer.own + 1);
}

}  // namespace

Decision decide(std::span<const Occupant> occupants, const Peer& newcomer, const Places& places,
                Timestamp now) {
  const auto own = static_cast<std::size_t>(std::count_if(
      occupants.begin(), occupants.end(), [&](const Occupant& o) { return o.peer == newcomer; }));
  const bool over_share = own >= places.per_peer;
  if (!over_share && occupants.size() < places.all) return {};
  const auto pick = [&](const auto& eligible) {
    std::optional<std::size_t> victim;
    for (std::size_t i = 0; i < occupants.size(); ++i) {
      if (!eligible(occupants[i])) continue;
      if (!victim || rank(occupants[i], occupants, now) > rank(occupants[*victim], occupants, now))
        victim = i;
    }
    return victim;
  };
  auto victim = pick([&](const Occupant& o) {
    return (!over_share || o.peer == newcomer) && mayGo(o, places, now);
  });
  if (!victim && !over_share) {
    const Held held = heldBy(newcomer, occupants);
    victim = pick([&](const Occupant& o) { return holdsMore(heldBy(o.peer, occupants), held); });
  }
  if (!victim) return {Decision::Kind::kRefuse, 0};
  return {Decision::Kind::kReplace, *victim};
}

}  // namespace merlin::net
