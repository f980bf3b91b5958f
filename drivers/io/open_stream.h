// Where a device's line is, and how it is opened: `serial:/dev/...` through libserialport,
// `pty:PATH` for an emulator or another program's pseudo-terminal, `tcp://HOST:PORT` for a raw
// serial server, `replay:FILE` for a transcript.
#pragma once

#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

enum class PortKind { kSerial, kPty, kTcp, kReplay };

struct PortAddress {
  PortKind kind = PortKind::kPty;
  std::string path;     // of a file; of kTcp the host
  std::string service;  // of kTcp alone: the port's number
};

// Errors: kInvalidArgument, with the forms that are understood.
Result<PortAddress> parsePort(std::string_view text);

// Opens the line. A serial line or a pty: 8 data bits, no parity, 1 stop bit, no flow control, raw;
// what was buffered before is dropped; low latency where the adapter knows it. Nobody else can open
// it meanwhile through MERLIN (an flock; TIOCEXCL does not stop root). A transcript runs at its own
// pace and ends. Errors: kNotFound, kBusy, kIo (a missing permission names the group to join); of
// openTcp and readTranscript.
Result<std::unique_ptr<ByteStream>> openPort(const PortAddress& address, int baud);

}  // namespace merlin::io
