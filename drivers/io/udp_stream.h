// `udp:PORT`: the datagrams that other programs send to a port of this machine, as a ByteStream of
// drivers/port/datagram_line.h's records.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

// Binds the port at `address`, an IPv4 or IPv6 address of this machine; 0.0.0.0 and :: are all of
// them. Every datagram that arrives there is passed on, whoever sent it; an empty one is left out.
// While nobody reads, the system keeps about 200 KB and drops what follows. write() of the stream
// always fails with kIo. Errors: kBusy (something else receives at this port), kIo, kNotFound (it
// is no address of this machine).
Result<std::unique_ptr<ByteStream>> openUdp(const std::string& address, const std::string& service);

}  // namespace merlin::io
