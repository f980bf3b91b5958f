// FlightStore: the memory of all flight rings of a process, in shared memory, where it outlives a
// process that is killed or crashes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/base/shared_memory.h"
#include "daemon/devices/flight_ring.h"

namespace merlin::devices {

// What a ring's device was called, for the dump's name and header.
struct FlightDevice {
  std::string name, driver;
  int baud = 0;
};

// Memory that a process of before left, since it ended without order. Read only.
class LeftFlight {
 public:
  LeftFlight() = default;  // of none
  // What lies under the shared memory's name, if its process is gone. What is damaged, or was
  // written by another version of this program, is left out.
  static LeftFlight under(const std::string& name);

  std::vector<FlightDevice> devices() const;        // without a name: there was none
  const FlightMemory& memory(std::size_t i) const;  // of devices()[i]

 private:
  SharedMemory memory_;
};

class FlightStore {
 public:
  // For this many devices, under a name such as "/merlin-flight". Replaces what lies there. Errors:
  // as for SharedMemory::create().
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
