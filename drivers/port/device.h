// Port: one device's dialogue. Implemented by drivers/<device>/device.
//
// Thread-bound. drivers/loop owns the order: open(stream), then poll(stream) until it fails, then
// open() again on a fresh stream. No call blocks longer than its contract says, and none after
// stream.interrupt().
#pragma once

#include <cstdint>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"

namespace merlin {

// Counts of a device's parser, over all its connections; they only grow.
struct DeviceCounters {
  std::uint64_t samples = 0;
  std::uint64_t bad_bytes = 0;
  std::uint64_t bad_packets = 0;
};

class Device {
 public:
  virtual ~Device() = default;

  // Resets, identifies and sets up the device, and starts its stream; returns what it said it is.
  // Errors: kTimeout (no or too short an answer), kMalformed (an answer of something else), and
  // the stream's. May allocate.
  virtual Result<std::string> open(ByteStream& stream) = 0;

  // Reads what comes within about 250 ms and publishes every whole sample in it.
  // Errors: kTimeout (silent for longer than this device ever is), and the stream's.
  // Takes no lock and allocates nothing, unless it fails.
  virtual Result<Ok> poll(ByteStream& stream) = 0;

  virtual DeviceCounters counters() const noexcept = 0;

  // A sentence where the device streams and yet is not well ("glove not plugged in"); else empty.
  virtual const char* complaint() const noexcept = 0;
};

}  // namespace merlin
