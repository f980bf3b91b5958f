// ByteTap: interface of a listener to the bytes of a line. Implemented by the recorder of
// `merlin record` and by the daemon's flight recorder.
#pragma once

#include <cstddef>
#include <span>

#include "daemon/base/clock.h"

namespace merlin {

// heard() gets bytes from the device, said() bytes to it. Called on the thread that uses the line;
// an implementation in the daemon takes no lock and allocates nothing.
class ByteTap {
 public:
  virtual ~ByteTap() = default;
  virtual void opened(Timestamp at) noexcept = 0;
  virtual void heard(Timestamp at, std::span<const std::byte> bytes) noexcept = 0;
  virtual void said(Timestamp at, std::span<const std::byte> bytes) noexcept = 0;
};

}  // namespace merlin
