// The JSON documents that MERLIN publishes, made from the shared-memory segments. Names and units
// are a contract (README.md): names may be added, but not changed or removed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"
#include "daemon/net/server_keeper.h"
#include "daemon/shm/device_slots.h"

namespace merlin::status {

// Returns the document of the topic "status" of the role devices, about 1 kB: health of the devices
// and of `servers`, postures and gestures.
std::string devicesStatus(const shm::DeviceSlots& devices, Timestamp now,
                          const std::vector<net::ServerHealth>& servers = {});
// The renderer that draws the wall.
struct RendererState {
  std::string name{}, vendor{}, driver{}, library{};  // from OpenGL; library: "EGL" or "OSMesa"
  std::string node{}, pci{};                          // of a GPU; empty if unknown
  bool software = true;                               // whether the CPU draws
  int contexts = 1;
  const char* read_back = "direct";  // or "asynchronous"
  const char* correction = "cpu";    // or "gpu": where outputs' corrections are computed
  std::string correction_fault{};    // why not where the setting says; empty: no fault
  const char* scan_out = "copied";   // or "drawn": how corrected signals reach displays
  std::string scan_out_fault{};      // why a signal is copied that could be drawn; empty: none is
};

// Returns the document of the topic "status" of the role wall. `servers`: health of its servers.
// `remote`: another machine's devices; null if the wall uses none. `renderer`: null before it is
// known.
std::string wallStatus(const shm::WallSegment& segment, Timestamp now,
                       const std::vector<net::ServerHealth>& servers = {},
                       const shm::DeviceSlots* remote = nullptr,
                       const RendererState* renderer = nullptr);
// The content folder, into which `merlin show FILE` puts files.
struct ShownFolderState {
  std::string path{};
  std::uint64_t limit_bytes = 0;     // of all files in it together
  std::string fault{};               // why it cannot be used; empty: it can
  std::vector<std::string> names{};  // names of its contents that `show` accepts, the newest first
};
// Returns `document`, a JSON object, with the member "shown_folder": {"path", "limit_bytes",
// "fault", "names"}.
std::string addShownFolder(const std::string& document, const ShownFolderState& folder);
// Returns `document`, a JSON object, with the member "missing_contents": {NAME: why it cannot be
// shown}; unchanged if `missing` is empty.
std::string addMissingContents(const std::string& document,
                               const std::vector<std::pair<std::string, std::string>>& missing);

// Returns the document of the topic "sample": the newest sample of each device and hand, the
// actions of their inputs, and the health of the devices.
std::string newestSamples(const shm::DeviceSlots& devices, Timestamp now);
// Return the document of the topic "metrics" of a role: a flat JSON object of counters and gauges
// for a metrics collector.
std::string devicesMetrics(const shm::DeviceSlots& devices);
std::string wallMetrics(const shm::WallSegment& segment);
// Returns a document of the topic "event", for one event at the time `now`. `kind`:
// EventKind::name.
std::string event(std::string_view kind, const Event& event, Timestamp now);

// Returns the texts as a JSON list, for a command's reply.
std::string textList(const std::vector<std::string>& texts);

}  // namespace merlin::status
