// What `merlin watch` shows on a terminal: rows made from a status document, events and frame
// times. Pure.
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
  std::string name;    // name of the daemon: its instance or its addresses
  std::string absent;  // why nothing is known at present; empty while the daemon answers
  // The statuses of all roles, joined by mergeStatus().
  nlohmann::ordered_json status = nlohmann::ordered_json::object();
  std::vector<WatchedEvent> events;  // oldest first
  FrameTimes frame_times;
};

struct ScreenSize {
  int rows = 24, columns = 80;
};

// Lays out title, wall, devices, outputs, failed services, chart and last events, as far as there
// is room: chart and events get the rows that the others leave. If not even those fit, the last row
// says how many rows are missing. While `absent` is not empty, the last state stays visible, but
// dim. Values of the wrong type in the status are shown as "-".
CellGrid layOut(const WatchedState& state, const ScreenSize& size, bool blocks);

}  // namespace merlin::cli
