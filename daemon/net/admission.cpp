#include "daemon/net/admission.h"

#include <algorithm>
#include <tuple>

namespace merlin::net {
namespace {

bool sameGroup(const Peer& a, const Peer& b) { return a.user == b.user && a.address == b.address; }

bool mayGo(const Occupant& o, const Places& places, Timestamp now) {
  return o.established ? now - o.active >= places.idle : now - o.since >= places.opening;
}

// The larger, the sooner it goes.
auto rank(const Occupant& o, std::span<const Occupant> all, Timestamp now) {
  const auto group = std::count_if(
      all.begin(), all.end(), [&](const Occupant& other) { return sameGroup(other.peer, o.peer); });
  const auto own = std::count_if(all.begin(), all.end(),
                                 [&](const Occupant& other) { return other.peer == o.peer; });
  return std::tuple(!o.established, group, own, now - o.active);
}

}  // namespace

Decision decide(std::span<const Occupant> occupants, const Peer& newcomer, const Places& places,
                Timestamp now) {
  const auto own = static_cast<std::size_t>(std::count_if(
      occupants.begin(), occupants.end(), [&](const Occupant& o) { return o.peer == newcomer; }));
  const bool over_share = own >= places.per_peer;
  if (!over_share && occupants.size() < places.all) return {};
  std::optional<std::size_t> victim;
  for (std::size_t i = 0; i < occupants.size(); ++i) {
    const Occupant& o = occupants[i];
    if ((over_share && o.peer != newcomer) || !mayGo(o, places, now)) continue;
    if (!victim || rank(o, occupants, now) > rank(occupants[*victim], occupants, now)) victim = i;
  }
  if (!victim) return {Decision::Kind::kRefuse, 0};
  return {Decision::Kind::kReplace, *victim};
}

}  // namespace merlin::net
