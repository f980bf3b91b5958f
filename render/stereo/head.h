// Head: where the viewer's eyes are, from a tracker station on the head. Pure.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "daemon/base/clock.h"
#include "drivers/port/samples.h"
#include "render/stereo/settings.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::stereo {

// Thread-bound.
class Head {
 public:
  // `configured`: the viewer while the head is not tracked. `eye_m`: place of that viewer in the
  // room. `still_after_s`: time without motion until the head counts as still.
  // REQUIRES: validate() of the settings found nothing.
  Head(const HeadSettings& settings, const tiles::Viewer& configured, const Eigen::Vector3d& eye_m,
       double still_after_s);

  struct View {
    tiles::Viewer viewer;
    bool moving = false;
    bool tracked = false;
  };
  // Once a frame. `sample`: the station's newest one, in the tracker's coordinates; nothing, or
  // something without finite figures: the head is not tracked, and the configured viewer returns,
  // which counts as motion. A head that moves is taken as it is, without a filter; at rest it stays
  // where it was until it has moved beyond the dead band. `now` never falls.
  View update(const std::optional<TrackerSample>& sample, Timestamp now);

 private:
  std::optional<tiles::Viewer> viewerOf(const TrackerSample& sample) const;
  bool isBeyondDeadBand(const tiles::Viewer& viewer) const;

  HeadSettings settings_;
  tiles::Viewer configured_;
  Eigen::Vector3d eye_m_;
  Duration still_after_;
  Eigen::Matrix3d R_room_tracker_;
  tiles::Viewer anchor_;  // the last one that counted as motion
  View view_;
  std::optional<Timestamp> last_motion_;
};

}  // namespace merlin::render::stereo
