// FlightRecorder: writes the bytes of the last minutes of a device to a file (a dump) when the
// device fails, on command, and after merlind crashed.
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

// Thread-bound to the thread of the status server, except for the rings, ringOf(), expectEnd() and
// mend().
class FlightRecorder {
 public:
  // Dumps are written into `folder` as INSTANCE-DEVICE-TIME.bytes. The newest eight of each device
  // are kept, also of earlier runs (see DatedFiles). `segment`: has the health of the devices; must
  // outlive this object.
  FlightRecorder(const shm::DevicesSegment& segment, std::string folder, std::string instance)
      : segment_(segment), folder_(std::move(folder)), instance_(std::move(instance)) {}

  // Places the rings of this many devices in the shared memory /INSTANCE-flight. Takes over the
  // bytes that a crashed process left there; the next check() writes them to files. To be called
  // before ringOf(). If it is not called or fails, the contents of the rings are lost with the
  // process. Errors: those of FlightStore::make().
  Result<Ok> keepForNextRun(std::size_t devices);

  // Returns the ring of the device with the index `device` in DevicesSegment::health; the first
  // call creates it. The ring exists as long as the recorder. `name` becomes a part of the dumps'
  // file names; `driver` and `baud` are written into the dumps' headers. Thread-safe.
  FlightRing& ringOf(std::size_t device, std::string name, std::string driver, int baud);
  Result<std::string> mend() { return store_ ? store_->mend() : std::string(); }
  // Tells the recorder that a device was stopped on purpose, so that check() does not dump it.
  // Thread-safe.
  void expectEnd(std::size_t device);

  // Dumps each device that has stopped working since the last call, unless it has failed with the
  // same reason before and worked only briefly in between (shm::kBriefly). The first call also
  // dumps the devices of an earlier run that crashed. Returns an event for each dump that was
  // written or failed.
  std::vector<Event> check();

  // Dumps every device that has a ring, and returns the paths of the files. Errors: those of
  // DatedFiles::next() and writeFile(), e.g. kIo.
  Result<std::vector<std::string>> dump();

 private:
  struct Entry {
    std::size_t place;  // index of the device in DevicesSegment::health
    FlightDevice device;
    std::unique_ptr<FlightRing> ring;
    bool was_well = false;
    std::int64_t well_ns = 0;  // start of the last period in which the device worked
    std::string fell;          // reason of its last failure
  };
  struct Dump {
    const FlightDevice& device;
    const FlightMemory& memory;
    std::string_view identity;  // as the device reported it; empty: not known
  };
  Result<std::string> write(const Dump& dump, std::string_view why) const;
  Result<std::string> write(const Entry& entry, std::string_view why) const;
  void writeLeft(std::vector<Event>& events);

  const shm::DevicesSegment& segment_;
  std::string folder_, instance_;
  std::optional<FlightStore> store_;  // declared before entries_, whose rings use it
  std::mutex mutex_;
  LeftFlight left_;             // guarded by mutex_; empty after it was written to files
  std::vector<Entry> entries_;  // guarded by mutex_
};

}  // namespace merlin::devices
