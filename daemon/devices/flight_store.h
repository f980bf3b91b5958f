// FlightStore: the memory of all flight rings of a process, in shared memory, so that it remains if
// the process is killed or crashes. LeftFlight: what such a process has left.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/base/shared_memory.h"
#include "daemon/devices/flight_ring.h"

namespace merlin::devices {

// Name, driver and speed of a ring's device, for the file name and the header of a dump.
struct FlightDevice {
  std::string name, driver;
  int baud = 0;
};

// Memory of flight rings that an earlier process left when it was killed or crashed. Read-only.
class LeftFlight {
 public:
  LeftFlight() = default;  // without devices
  // Opens the shared memory with this name. The result is empty if there is none, if the process
  // that owns it still runs, or if the memory is damaged or has another layout than this program's.
  static LeftFlight under(const std::string& name);

  std::vector<FlightDevice> devices() const;        // a device with an empty name is to be ignored
  const FlightMemory& memory(std::size_t i) const;  // contents of the ring of devices()[i]

 private:
  SharedMemory memory_;
};

class FlightStore {
 public:
  // Creates the memory for this many devices under a name such as "/merlin-flight", in place of
  // memory that a dead process left under this name. Errors: those of SharedMemory::create().
  // REQUIRES: devices <= kMostDevices.
  static Result<FlightStore> make(const std::string& name, std::size_t devices);

  // Stores name, driver and speed of the device whose bytes memory(i) receives. REQUIRES: i <
  // devices.
  void describe(std::size_t i, const FlightDevice& device);
  FlightMemory& memory(std::size_t i) const;
  Result<std::string> mend() { return memory_.mend(); }  // see SharedMemory::mend()

 private:
  explicit FlightStore(SharedMemory memory) : memory_(std::move(memory)) {}
  SharedMemory memory_;
};

}  // namespace merlin::devices
