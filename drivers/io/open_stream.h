// Opens a device's line (drivers/port/port_address.h): serial ports through libserialport,
// pseudo-terminals, raw serial servers, ports for datagrams, local sockets, input devices,
// transcripts.
#pragma once

#include <memory>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"
#include "drivers/port/port_address.h"

namespace merlin::io {

// Opens the line at `address`. A serial line or a pty is set to `baud`, 8 data bits, no parity, 1
// stop bit, no flow control and raw mode; bytes that were buffered before are dropped. A serial
// adapter is set to low latency if it supports that. While the line is open, no other process of
// MERLIN can open it (by flock, because TIOCEXCL does not stop root). A transcript is replayed with
// the timing of its recording, then ends. Errors: kNotFound, kBusy, kIo (if permission is missing,
// the message names the group to join); those of openTcp(), openUdp(), openUnix(), openEvdev() and
// readTranscript().
Result<std::unique_ptr<ByteStream>> openPort(const PortAddress& address, int baud);

}  // namespace merlin::io
