// Lays out the screen of `merlin watch`: rows made from a status document, events and frame times.
// Pure.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/cli/watch/cell_grid.h"
#include "daemon/cli/watch/frame_chart.h"

namespace merlin::cli {

struct WatchedEvent {
  std::string time_utc;  // ISO 8601
  std::string what;      // a sentence
};

struct WatchedState {
  std::string name;    // the instance of the daemon, or its addresses
  std::string absent;  // why the daemon does not answer at present; empty while it answers
  // The status of all roles, merged by mergeStatus().
  nlohmann::ordered_json status = nlohmann::ordered_json::object();
  std::vector<WatchedEvent> events;  // oldest first
  FrameTimes frame_times;
};

struct ScreenSize {
  int rows = 24, columns = 80;
};

// Lays out title, wall, devices, outputs and failed services; the chart and the last events get the
// remaining rows. If the others do not fit, the last row says how many rows are missing. While
// state.absent is not empty, the last state stays visible but dim. Values of the wrong type in the
// status are shown as "-". `blocks`: as for drawChart().
CellGrid layOut(const WatchedState& state, const ScreenSize& size, bool blocks);

}  // namespace merlin::cli
