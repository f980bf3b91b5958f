// ViewerPlace: adapts the viewing frusta of the wall's tiles to the position of the viewer's
// tracked head.
#pragma once

#include <functional>
#include <optional>

#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"
#include "render/stereo/head.h"
#include "render/tiles/tile_plan.h"

namespace merlin::wall {

// Thread-bound to the wall's thread.
class ViewerPlace {
 public:
  // `plan`: the tile plan used for drawing; must outlive this object. `station`: number of the
  // tracker's station on the head, for messages. `report` is called with an event when the station
  // begins or ceases to deliver the head's pose, and when the eyes come too close to a screen.
  ViewerPlace(render::stereo::Head head, int station, render::tiles::TilePlan& plan,
              std::function<void(Event)> report);

  // Updates the plan's frusta for the head's sample; nothing: there is none. Returns true while the
  // head moves. To be called once a frame, while nothing is drawn.
  bool update(const std::optional<TrackerSample>& sample, Timestamp now);

  // Time from the first update() after which the station is reported as missing if no sample has
  // arrived.
  static constexpr Duration kPatience = std::chrono::seconds(3);

 private:
  void reportTracking(bool tracked, Timestamp now);

  render::stereo::Head head_;
  int station_;
  render::tiles::TilePlan& plan_;
  std::function<void(Event)> report_;
  std::optional<Timestamp> began_;
  std::optional<bool> tracked_;  // last reported state; nothing: none was reported yet
  bool is_placed_ = true;        // whether the frusta fit the head's last position
};

}  // namespace merlin::wall
