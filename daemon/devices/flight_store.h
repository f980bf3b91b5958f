// FlightStore: the memory of all flight rings of a process, in shared memory, where it outlives a
// process that is killed or crashes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/base/shared_memory.h"
#include "daemon/devices/flight_ring.h"

namespace merlin::devices {

// Name and driver of a ring's device, for the dump's name and header.
struct FlightDevice {
  std::string name, driver;
  int baud = 0;
};

// Memory left by an earlier process that was killed or crashed. Read only.
class LeftFlight {
 public:
  LeftFlight() = default;  // empty
  // The content of the shared memory with this name, if its process is gone; without what is
  // damaged or was written by another version of this program.
  static LeftFlight under(const std::string& name);

  std::vector<FlightDevice> devices() const;        // an empty name: no device
  const FlightMemory& memory(std::size_t i) const;  // of devices()[i]

 private:
  SharedMemory memory_;
};

class FlightStore {
 public:
  // Creates the memory for this many devices, under a name such as "/merlin-flight". Replaces an
  // existing one. Errors: as for SharedMemory::create().
  static Result<FlightStore> make(const std::string& name, std::size_t devices);

  // Names the device whose bytes the memory has. REQUIRES: i < devices.
  void describe(std::size_t i, const FlightDevice& device);
  FlightMemory& memory(std::size_t i) const;
  Result<std::string> mend() { return memory_.mend(); }  // SharedMemory::mend()

 private:
  explicit FlightStore(SharedMemory memory) : memory_(std::move(memory)) {}
  SharedMemory memory_;
};

}  // namespace merlin::devices
