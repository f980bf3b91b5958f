// Where a device's line is, and how it is opened: `serial:/dev/...` through libserialport,
// `pty:PATH` for an emulator or another program's pseudo-terminal.
#pragma once

#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

enum class PortKind { kSerial, kPty };

struct PortAddress {
  PortKind kind = PortKind::kPty;
  std::string path;
};

// Errors: kInvalidArgument, with the forms that are understood.
Result<PortAddress> parsePort(std::string_view text);

// Opens the line: 8 data bits, no parity, 1 stop bit, no flow control, raw; what was buffered
// before is dropped. Nobody else can open it meanwhile through MERLIN (an flock; TIOCEXCL does not
// stop root). Errors: kNotFound, kBusy, kIo (a missing permission names the group to join).
Result<std::unique_ptr<ByteStream>> openPort(const PortAddress& address, int baud);

}  // namespace merlin::io
