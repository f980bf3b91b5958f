// Emulator: a device's inverse. Bytes that a program sends go in, bytes that the device would send
// come out, on whatever clock the caller has. Pure: no I/O, no clock.
//
// Served on a pty by daemon/cli/emulate, driven directly by tests. Thread-bound.
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

  // Bytes from the program, that arrived at `now`.
  virtual void receive(std::span<const std::byte> bytes, Timestamp now) = 0;

  // Appends to `out` the bytes that the device sends until `now`. To be called again no later than
  // nextDue().
  virtual void advance(Timestamp now, std::string& out) = 0;

  // When it has something to send by itself.
  virtual Timestamp nextDue() const = 0;
};

struct EmulatorSettings {
  int baud = 38400;          // the line's speed: records that do not fit are dropped, as by the box
  std::string model = {};    // of the device, empty for its default; see the table
  std::uint64_t person = 0;  // who wears the glove: drivers/hand/people
  std::uint64_t seed = 1;    // of noise and garbage
  int garbage_every = 0;     // records between two bursts of garbage; 0 for none
};

// One row a device that can be emulated.
struct EmulatorEntry {
  const char* name;    // as in drivers/registry
  int baud;            // default
  const char* models;  // what EmulatorSettings::model may be, "a|b|c"; the first is the default
  const char* help;
  std::unique_ptr<Emulator> (*make)(const EmulatorSettings&, const MotionScript&, Timestamp start);
};

std::span<const EmulatorEntry> emulators();
const EmulatorEntry* findEmulator(std::string_view name);  // nullptr if there is none

// Whether `model` is one of the entry's, or empty for its default.
bool hasModel(const EmulatorEntry& entry, std::string_view model);

}  // namespace merlin::emulate
