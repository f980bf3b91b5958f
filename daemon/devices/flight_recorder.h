// FlightRecorder: writes a device's last minutes into a file when it fails, or when asked.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "daemon/devices/flight_ring.h"
#include "daemon/shm/layout.h"

namespace merlin::devices {

// Thread-bound to the status server's thread, but for the rings.
class FlightRecorder {
 public:
  // Dumps go into `folder`: INSTANCE-DRIVER-TIME.bytes, the newest eight of a driver, also those of
  // earlier runs (DatedFiles).
  FlightRecorder(const shm::DevicesSegment& segment, std::string folder, std::string instance)
      : segment_(segment), folder_(std::move(folder)), instance_(std::move(instance)) {}

  // The ring of a device that has a line; lives as long as this. `driver` and `baud` go into the
  // header of what is dumped.
  FlightRing& add(shm::DeviceIndex device, std::string driver, int baud);

  // Dumps each device that was well at the last look and is not any more; a sentence for each.
  std::vector<std::string> check();

  // Dumps every device; the files' names. Errors: kIo.
  Result<std::vector<std::string>> dump();

 private:
  struct Entry {
    shm::DeviceIndex device;
    std::string driver;
    int baud;
    std::unique_ptr<FlightRing> ring;
    bool was_well = false;
  };
  Result<std::string> write(const Entry& entry, std::string_view why);

  const shm::DevicesSegment& segment_;
  std::string folder_, instance_;
  std::vector<Entry> entries_;
};

}  // namespace merlin::devices
