// ViewerPlace: adapts the frusta of the wall's tiles to the position of the viewer's tracked head.
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
  // `plan`: the tile plan used for drawing; must outlive this object. `report` is called with an
  // event when the tracker station `station` begins or ceases to deliver the head's pose.
  ViewerPlace(render::stereo::Head head, int station, render::tiles::TilePlan& plan,
              std::function<void(Event)> report);

  // To be called once a frame, while nothing is drawn: updates the plan's frusta. Returns true
  // while the head moves.
  bool update(const std::optional<TrackerSample>& sample, Timestamp now);

  // Time after the first update() without any sample, after which the station is reported as
  // missing.
  static constexpr Duration kPatience = std::chrono::seconds(3);

 private:
  void reportTracking(bool tracked, Timestamp now);

  render::stereo::Head head_;
  int station_;
  render::tiles::TilePlan& plan_;
  std::function<void(Event)> report_;
  std::optional<Timestamp> began_;
  std::optional<bool> tracked_;  // last reported state; nullopt before the first report
  bool is_placed_ = true;        // the frusta fit the head's current position
};

}  // namespace merlin::wall
