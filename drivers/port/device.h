// Device: the interface of a device driver. Implemented by drivers/<device>/device.
//
// Thread-bound. drivers/loop calls open(stream), then poll(stream) until that fails, then open()
// again with a new stream. No call blocks longer than its contract says, and none blocks after
// stream.interrupt().
#pragma once

#include <cstdint>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"

namespace merlin {

// Counters of a device's parser since its construction, over all connections.
struct DeviceCounters {
  std::uint64_t samples = 0;
  std::uint64_t bad_bytes = 0;
  std::uint64_t bad_packets = 0;
};

class Device {
 public:
  virtual ~Device() = default;

  // Resets, identifies and sets up the device, and starts its stream; returns the device's identity
  // for a person ("CyberGlove, 22 sensors"). Errors: kTimeout (no answer or an incomplete one),
  // kMalformed (the answer is not that of such a device), and those of the stream. May allocate.
  virtual Result<std::string> open(ByteStream& stream) = 0;

  // Reads the bytes that arrive within about 250 ms and publishes every complete sample in them.
  // Errors: kTimeout (silent for longer than a working device ever is), and those of the stream.
  // Takes no lock and allocates nothing, unless it fails.
  virtual Result<Ok> poll(ByteStream& stream) = 0;

  virtual DeviceCounters counters() const noexcept = 0;

  // Describes a fault of a device that nevertheless streams ("glove not plugged in"); empty: none.
  virtual const char* complaint() const noexcept = 0;
};

}  // namespace merlin
