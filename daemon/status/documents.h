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

// Topic "status" of the role devices: health of the devices, and the posture. About 1 kB.
std::string devicesStatus(const shm::DeviceSlots& devices, Timestamp now,
                          const std::vector<net::ServerHealth>& servers = {});
// The renderer that draws the wall.
struct RendererState {
  std::string name{}, vendor{}, driver{}, library{};  // from OpenGL; library: "EGL" or "OSMesa"
  std::string node{}, pci{};                          // of a GPU; empty if unknown
  bool software = true;                               // drawn by the CPU
  int contexts = 1;
  const char* read_back = "direct";  // or "asynchronous"
  const char* correction = "cpu";    // where outputs' corrections are computed, or "gpu"
  std::string correction_fault{};    // why they are not computed where set; empty: no fault
  const char* scan_out = "copied";   // how corrected signals come to displays, or "drawn"
  std::string scan_out_fault{};      // why one is copied that might be drawn; empty: none is
};

// Topic "status" of the role wall. `remote`: another machine's devices, if the wall uses them.
// `renderer`: null before it is known.
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
// The same with "missing_contents": {NAME: why it cannot be shown}, which is omitted if no content
// is missing.
std::string addMissingContents(const std::string& document,
                               const std::vector<std::pair<std::string, std::string>>& missing);

// Topic "sample": the newest posture, glove, hand, tracker and ball, and the actions of their
// inputs.
std::string newestSamples(const shm::DeviceSlots& devices, Timestamp now);
// Topic "metrics" of either role: a flat list of counters and gauges for a metrics collector.
std::string devicesMetrics(const shm::DeviceSlots& devices);
std::string wallMetrics(const shm::WallSegment& segment);
// Topic "event": one thing that happened. `kind` is a word.
std::string event(std::string_view kind, const Event& event, Timestamp now);

// A list of texts, as a command's reply.
std::string textList(const std::vector<std::string>& texts);

}  // namespace merlin::status
