// Settings of what the wall shows while nobody is there, and of files that clients have it show.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"

namespace merlin {

struct PlaylistSettings {
  double after_s = 0;                 // time without input until it begins; 0: only by command
  double hold_s = 60;                 // time that each content is shown
  double turn_deg_per_s = 6;          // of a model about the vertical axis; of a panorama, its view
  std::vector<std::string> contents;  // names, in the order in which they are shown; empty: all
  double dim_after_s = 0;             // time without input until the picture is dimmed; 0: never
  double dim_to = 0.3;                // brightness while dimmed, as a share of the full light
};

struct ShownSettings {
  std::string folder;    // for `merlin show FILE`; empty: one beside the file of the state
  int limit_mb = 4'096;  // of all files in it together
};

}  // namespace merlin
