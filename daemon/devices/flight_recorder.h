// FlightRecorder: writes the last minutes of a device's bytes to a file when it fails, or on
// command.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/event_kinds.h"
#include "daemon/devices/flight_ring.h"
#include "daemon/shm/layout.h"

namespace merlin::devices {

// Thread-bound to the status server's thread, except for the rings, ringOf() and expectEnd().
class FlightRecorder {
 public:
  // Dumps are written into `folder` as INSTANCE-DEVICE-TIME.bytes; the newest eight of each device
  // are kept, including those of earlier runs (DatedFiles).
  FlightRecorder(const shm::DevicesSegment& segment, std::string folder, std::string instance)
      : segment_(segment), folder_(std::move(folder)), instance_(std::move(instance)) {}

  // Returns the ring of the device with this index in DevicesSegment::health, which lives as long
  // as the recorder; the first call makes it. `name` goes into the names of its dumps, `driver` and
  // `baud` into their headers. Thread-safe.
  FlightRing& ringOf(std::size_t device, std::string name, std::string driver, int baud);
  // The device was stopped on purpose: no reason for a dump. Thread-safe.
  void expectEnd(std::size_t device);

  // Dumps each device that has stopped working since the last call; returns a sentence for each.
  std::vector<Event> check();

  // Dumps every device and returns the files' names. Errors: kIo.
  Result<std::vector<std::string>> dump();

 private:
  struct Entry {
    std::size_t device;
    std::string name;
    std::string driver;
    int baud;
    std::unique_ptr<FlightRing> ring;
    bool was_well = false;
  };
  Result<std::string> write(const Entry& entry, std::string_view why);

  const shm::DevicesSegment& segment_;
  std::string folder_, instance_;
  std::mutex mutex_;
  std::vector<Entry> entries_;  // guarded by mutex_
};

}  // namespace merlin::devices
