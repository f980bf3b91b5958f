// FlightRecorder: writes the last minutes of a device's bytes to a file when the device fails, on
// command, and after merlind crashed.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/event_kinds.h"
#include "daemon/devices/flight_ring.h"
#include "daemon/devices/flight_store.h"
#include "daemon/shm/layout.h"

namespace merlin::devices {

// Thread-bound to the status server's thread, except for the rings, ringOf() and expectEnd().
class FlightRecorder {
 public:
  // Dumps are written into `folder` as INSTANCE-DEVICE-TIME.bytes; the newest eight of each device
  // are kept, including those of earlier runs (DatedFiles).
  FlightRecorder(const shm::DevicesSegment& segment, std::string folder, std::string instance)
      : segment_(segment), folder_(std::move(folder)), instance_(std::move(instance)) {}

  // Places the rings of this many devices in shared memory, /INSTANCE-flight. Takes over the bytes
  // that a crashed process left there, which check() writes to files. To be called before ringOf().
  // Without it, or if it fails, the rings end with the process. Errors: as for FlightStore::make().
  Result<Ok> keepForNextRun(std::size_t devices);

  // Returns the ring of the device with this index in DevicesSegment::health, which lives as long
  // as the recorder; the first call makes it. Its name goes into the names of its dumps, driver and
  // speed into their headers. Thread-safe.
  FlightRing& ringOf(std::size_t device, std::string name, std::string driver, int baud);
  Result<std::string> mend() { return store_ ? store_->mend() : std::string(); }
  // Tells the recorder that the device is stopped on purpose, which is no reason for a dump.
  // Thread-safe.
  void expectEnd(std::size_t device);

  // Dumps each device that has stopped working since the last call, unless it had failed in the
  // same way before and worked only briefly since then (shm::kBriefly). Also dumps the devices of
  // an earlier run that crashed. Returns a sentence for each dump.
  std::vector<Event> check();

  // Dumps every device and returns the files' names. Errors: kIo.
  Result<std::vector<std::string>> dump();

 private:
  struct Entry {
    std::size_t place;  // of the device, in DevicesSegment::health
    FlightDevice device;
    std::unique_ptr<FlightRing> ring;
    bool was_well = false;
    std::int64_t well_ns = 0;  // begin of the last period in which it was well
    std::string fell;          // why it failed last
  };
  struct Dump {
    const FlightDevice& device;
    const FlightMemory& memory;
    std::string_view identity;  // empty: not known
  };
  Result<std::string> write(const Dump& dump, std::string_view why) const;
  Result<std::string> write(const Entry& entry, std::string_view why) const;
  void writeLeft(std::vector<Event>& events);

  const shm::DevicesSegment& segment_;
  std::string folder_, instance_;
  std::optional<FlightStore> store_;  // outlives the rings
  std::mutex mutex_;
  LeftFlight left_;             // guarded by mutex_; empty once it is written
  std::vector<Entry> entries_;  // guarded by mutex_
};

}  // namespace merlin::devices
