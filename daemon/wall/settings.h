// Settings of what the wall shows while nobody is there, and of the files that clients want it to
// show.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"

namespace merlin {

struct PlaylistSettings {
  double after_s = 0;         // time without input until the playlist begins; 0: only by command
  double hold_s = 60;         // time that each content is shown
  double turn_deg_per_s = 6;  // speed of a model about the vertical axis; or of a panorama's view
  std::vector<std::string> contents;  // names of contents in the order shown; empty: all
  double dim_after_s = 0;             // time without input until the picture is dimmed; 0: never
  double dim_to = 0.3;                // brightness while dimmed, as a share of the full light
};

struct ShownSettings {
  std::string folder;    // content folder; empty: a folder beside the state file
  int limit_mb = 4'096;  // maximum size of all files in it together
};

}  // namespace merlin
