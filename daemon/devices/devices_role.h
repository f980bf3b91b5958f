// DevicesRole: reads the configured devices, each on its own thread, and writes their samples into
// shared memory.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/actions/action_writer.h"
#include "daemon/base/clock.h"
#include "daemon/base/unique_fd.h"
#include "daemon/base/watched_thread.h"
#include "daemon/devices/device_chain.h"
#include "daemon/devices/flight_recorder.h"
#include "daemon/devices/projectors.h"
#include "daemon/shm/segment.h"
#include "daemon/shm/shm_sink.h"
#include "drivers/gpio/panel_loop.h"
#include "drivers/loop/device_loop.h"
#include "drivers/registry.h"

namespace merlin::devices {

// Which groups of the devices' settings differ after a reload.
struct DevicesChanges {
  bool bindings = false, hand = false, postures = false, gestures = false;
  std::vector<bool> lines;  // for each device: whether its line's or driver's settings differ
};

class DevicesRole {
 public:
  // Creates the segment; starts no thread. `generation`: shm::newGeneration(). `watch` and `clock`
  // must outlive the role. Errors: kBusy (a running daemon owns the segment), kIo, those of
  // loadTrained(), and those of parsing a port. REQUIRES: settings.run_directory is the directory
  // in use, not empty.
  static Result<std::unique_ptr<DevicesRole>> make(const Settings& settings,
                                                   std::uint64_t generation,
                                                   const shm::Endpoints& endpoints,
                                                   ThreadWatch& watch, Clock& clock);
  ~DevicesRole();  // stops and joins the device threads
  DevicesRole(const DevicesRole&) = delete;
  DevicesRole& operator=(const DevicesRole&) = delete;

  // Starts a thread for each device that has a port, with real-time priority if the system allows
  // it, and threads for the panel and the PJLink projectors.
  void start();

  // Applies these settings while the devices run. `changes`: the groups that differ from the
  // present settings. Only the threads of the devices in `changes.lines` are stopped, which takes
  // up to 50 ms for each, and started again; all other settings are exchanged between two samples.
  // `trained`: the result of loadTrained() for these settings. REQUIRES: start() was called; every
  // driver exists and every port can be parsed; the devices and hands have the same number, order,
  // names and kinds as before.
  void reload(const Settings& settings, const DevicesChanges& changes, const Trained& trained);

  void writeHeartbeat(Timestamp now) const { segment_.writeHeartbeat(now); }
  // Restores the segment and the memory of the flight recorder: see SharedMemory::mend().
  Result<std::string> mend();
  // Returns the slots of the role's own segment, for reading.
  const shm::DeviceSlots& slots() const { return slots_; }
  // Returns the loop of the control panel; null if no panel is configured. Thread-safe.
  gpio::PanelLoop* panel() { return panel_.get(); }
  // Returns the slot with the health of the control panel; null if no panel is configured.
  const shm::SeqSlot<DeviceHealth>* panelHealth() const {
    return panel_ ? &segment_->gpio_health : nullptr;
  }
  // Returns the projectors, of which only the thread-safe members may be called; null if none is
  // configured, neither at the panel nor by PJLink.
  Projectors* projectors() { return projectors_.get(); }
  // Returns the state of the projectors at the panel's GPIO line as that of one projector named
  // "panel"; nothing if no such line is configured. Thread-safe.
  std::optional<pjlink::ProjectorState> panelProjectors() const;
  // Returns the flight recorder of all devices that have a port. For the thread of the status
  // server.
  FlightRecorder& flight() { return flight_; }

 private:
  struct Memory {
    shm::SegmentWriter<shm::DevicesSegment> segment;
    shm::DeviceSlots slots;  // slots in `segment`
  };
  DevicesRole(Memory memory, const Settings& settings, std::uint64_t generation, ThreadWatch& watch,
              Clock& clock);
  void addPanel(const DevicesSettings& settings);
  void addProjectors(const DevicesSettings& settings);
  // One configured device. `loop` and `thread` are recreated when the settings of its line change.
  struct Line {
    std::string name;  // name of the device
    std::unique_ptr<DeviceChain> chain;
    Progress* progress = nullptr;      // set by the thread when it starts
    std::unique_ptr<DeviceLoop> loop;  // null: the device has no port
    WatchedThread thread;
  };
  void publishFrames(const DevicesSettings& settings, std::size_t device);
  Result<Ok> open(std::size_t device, const DevicesSettings& settings);
  void start(Line& line);
  void close(std::size_t device);

  shm::SegmentWriter<shm::DevicesSegment> segment_;
  shm::DeviceSlots slots_;
  ThreadWatch& watch_;
  Clock& clock_;
  FlightRecorder flight_;
  std::unique_ptr<actions::ActionWriter> panel_actions_;
  std::unique_ptr<gpio::PanelLoop> panel_;
  bool panel_switches_projectors_ = false;
  std::unique_ptr<Projectors> projectors_;  // calls panel_
  std::unique_ptr<shm::ShmHealthSink> panel_health_;
  std::uint64_t generation_;
  int cpu_latency_us_ = -1;
  UniqueFd cpu_latency_;                      // the limit is in effect while this is open
  std::vector<std::unique_ptr<Line>> lines_;  // in the order of DevicesSettings::list
  std::vector<WatchedThread> threads_;        // threads of the panel and the projectors
};

}  // namespace merlin::devices
