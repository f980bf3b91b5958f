// `udp:PORT`: the datagrams that other programs send to a port of this machine, as a ByteStream of
// drivers/port/datagram_line.h's records.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

// Binds the port at `address`, an IPv4 or IPv6 address of this machine; 0.0.0.0 and :: mean all of
// its addresses. The stream passes on every datagram that arrives there, from any sender, except
// empty ones. While nobody reads, the system buffers about 200 KB and drops further datagrams.
// write() of the stream always fails with kIo. Errors: kBusy (another program receives at this
// port), kIo, kNotFound (this machine does not have that address).
Result<std::unique_ptr<ByteStream>> openUdp(const std::string& address, const std::string& service);

}  // namespace merlin::io
