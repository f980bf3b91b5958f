// Emulator: simulates a device. It takes the bytes that a program sends to the device, and returns
// the bytes that the device would send. Pure: no I/O; the time is passed in.
//
// daemon/cli/line/emulate.cpp serves an emulator on a pty; tests call it directly. Thread-bound.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "daemon/base/clock.h"
#include "drivers/emulate/motion.h"

namespace merlin::emulate {

class Emulator {
 public:
  virtual ~Emulator() = default;

  // Takes bytes that the program has sent and that arrive at `now`.
  virtual void receive(std::span<const std::byte> bytes, Timestamp now) = 0;

  // Appends to `out` the bytes that the device sends until `now`. Must be called again no later
  // than nextDue().
  virtual void advance(Timestamp now, std::string& out) = 0;

  // Returns when the device will next send something without being asked.
  virtual Timestamp nextDue() const = 0;
};

struct EmulatorSettings {
  // Speed of the line; records that do not fit are dropped, as the device does.
  int baud = 38400;
  std::string model = {};    // one of EmulatorEntry::models; empty: the default
  std::uint64_t person = 0;  // seed of the Person who wears the glove (drivers/hand/people.h)
  std::uint64_t seed = 1;    // seed of the noise and of the random bytes
  int garbage_every = 0;     // records between two bursts of random bytes; 0: no bursts
};

// A device that can be emulated.
struct EmulatorEntry {
  const char* name;    // name of its driver in drivers/registry
  int baud;            // default baud rate
  const char* models;  // what EmulatorSettings::model may be, "a|b|c"; the first is the default
  const char* help;
  std::unique_ptr<Emulator> (*make)(const EmulatorSettings&, const MotionScript&, Timestamp start);
};

std::span<const EmulatorEntry> emulators();
const EmulatorEntry* findEmulator(std::string_view name);  // nullptr if there is none

// Returns whether `model` is one of the entry's models, or empty, which means the default.
bool hasModel(const EmulatorEntry& entry, std::string_view model);

}  // namespace merlin::emulate
