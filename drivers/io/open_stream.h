// Opens a device's line (drivers/port/port_address.h): serial ports through libserialport,
// pseudo-terminals, raw serial servers, transcripts.
#pragma once

#include <memory>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"
#include "drivers/port/port_address.h"

namespace merlin::io {

// Opens the line. A serial line or a pty: 8 data bits, no parity, 1 stop bit, no flow control, raw;
// what was buffered before is dropped; low latency where the adapter knows it. Nobody else can open
// it meanwhile through MERLIN (an flock; TIOCEXCL does not stop root). A transcript runs at its own
// pace and ends. Errors: kNotFound, kBusy, kIo (a missing permission names the group to join); of
// openTcp and readTranscript.
Result<std::unique_ptr<ByteStream>> openPort(const PortAddress& address, int baud);

}  // namespace merlin::io
