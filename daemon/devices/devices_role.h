// DevicesRole: reads the configured devices, each on its own thread, and writes their samples into
// shared memory.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/actions/action_sink.h"
#include "daemon/actions/action_writer.h"
#include "daemon/base/clock.h"
#include "daemon/base/unique_fd.h"
#include "daemon/base/watched_thread.h"
#include "daemon/devices/flight_recorder.h"
#include "daemon/devices/hand_sink.h"
#include "daemon/devices/posture_sink.h"
#include "daemon/devices/projectors.h"
#include "daemon/shm/segment.h"
#include "daemon/shm/shm_sink.h"
#include "drivers/gpio/panel_loop.h"
#include "drivers/loop/device_loop.h"
#include "drivers/registry.h"

namespace merlin::devices {

class DevicesRole {
 public:
  // Creates the segment; starts no thread. Errors: kBusy (a running daemon owns the segment), kIo,
  // those of the posture network's file.
  // REQUIRES: settings.run_directory is the directory in use, not empty.
  static Result<std::unique_ptr<DevicesRole>> make(const Settings& settings,
                                                   std::uint64_t generation,
                                                   const shm::Endpoints& endpoints,
                                                   ThreadWatch& watch, Clock& clock);
  ~DevicesRole();  // stops and joins the device threads
  DevicesRole(const DevicesRole&) = delete;
  DevicesRole& operator=(const DevicesRole&) = delete;

  // Starts a thread for each device that has a port, with real-time priority if the system allows
  // it.
  void start();

  void writeHeartbeat(Timestamp now) const { segment_.writeHeartbeat(now); }
  Result<std::string> mend() { return segment_.mend(); }  // SegmentWriter::mend()
  // The role's own slots, found as any reader finds them.
  const shm::DeviceSlots& slots() const { return slots_; }
  // Null if no panel is configured. Thread-safe.
  gpio::PanelLoop* panel() { return panel_.get(); }
  // Null if no projector is configured, at the panel or by PJLink. Thread-safe, as it says.
  Projectors* projectors() { return projectors_.get(); }
  // The projectors at the panel's line, as a projector named "panel"; nothing if there are none.
  // Thread-safe.
  std::optional<pjlink::ProjectorState> panelProjectors() const;
  // The flight recorder of all devices that have a port. For the status server's thread.
  FlightRecorder& flight() { return flight_; }

 private:
  struct Memory {
    shm::SegmentWriter<shm::DevicesSegment> segment;
    shm::DeviceSlots slots;  // of segment
  };
  DevicesRole(Memory memory, const Settings& settings, std::uint64_t generation, ThreadWatch& watch,
              Clock& clock);
  void addPanel(const DevicesSettings& settings);
  void addProjectors(const DevicesSettings& settings);
  Result<Ok> add(const LineSettings& line, SampleKind kind, shm::DeviceIndex index,
                 const Settings& settings);
  struct Sinks {
    SampleSink* samples;
    HealthSink* health;
  };
  Result<Sinks> sinksFor(SampleKind kind, HealthSink& health, const DevicesSettings& settings);

  shm::SegmentWriter<shm::DevicesSegment> segment_;
  shm::DeviceSlots slots_;
  ThreadWatch& watch_;
  Clock& clock_;
  shm::ShmSink sink_;
  FlightRecorder flight_;
  std::unique_ptr<PostureSink> posture_sink_;
  std::unique_ptr<HandSink> hand_sink_;
  std::unique_ptr<actions::ActionWriter> panel_actions_;
  std::unique_ptr<gpio::PanelLoop> panel_;
  bool panel_switches_projectors_ = false;
  std::unique_ptr<Projectors> projectors_;  // calls panel_
  std::vector<std::unique_ptr<shm::ShmHealthSink>> health_;
  std::vector<std::unique_ptr<actions::ActionSink>> action_sinks_;
  std::uint64_t generation_;
  // A device's loop; `progress` is set when its thread starts.
  struct Line {
    std::string name;
    Progress* progress = nullptr;
    std::unique_ptr<DeviceLoop> loop;
  };
  std::vector<std::unique_ptr<Line>> lines_;
  int cpu_latency_us_ = -1;
  UniqueFd cpu_latency_;  // the limit is in effect while this is open
  std::vector<WatchedThread> threads_;
};

}  // namespace merlin::devices
