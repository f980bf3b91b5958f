// Head: computes the places of the viewer's eyes from a tracker station on the head. Pure.
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
  // `configured`: the viewer while the head is not tracked. `eye_m`: position of that viewer in the
  // room. `still_after_s`: time without motion until the head counts as still.
  // REQUIRES: validate() of the settings found nothing.
  Head(const HeadSettings& settings, const tiles::Viewer& configured, const Eigen::Vector3d& eye_m,
       double still_after_s);

  struct View {
    tiles::Viewer viewer;
    bool moving = false;
    bool tracked = false;
  };
  // Call once a frame. `sample`: the station's newest sample, in the tracker's coordinates. If
  // there is none, or its values are not finite, the head is not tracked and the configured viewer
  // is used; that change counts as motion. The position of a moving head is used without a filter;
  // a head at rest keeps its position until it has moved beyond the dead band. REQUIRES: `now`
  // never decreases.
  View update(const std::optional<TrackerSample>& sample, Timestamp now);

 private:
  std::optional<tiles::Viewer> viewerOf(const TrackerSample& sample) const;
  bool isBeyondDeadBand(const tiles::Viewer& viewer) const;

  HeadSettings settings_;
  tiles::Viewer configured_;
  Eigen::Vector3d eye_m_;
  Duration still_after_;
  Eigen::Matrix3d R_room_tracker_;
  tiles::Viewer anchor_;  // the last viewer that counted as motion
  View view_;
  std::optional<Timestamp> last_motion_;
};

}  // namespace merlin::render::stereo
