// `tcp://HOST:PORT`: a raw serial server (ser2net, a terminal server) as a device's line.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

// Connects within a second for each address of the host. Small packets are not delayed. A server
// that vanishes without closing the connection is noticed within about five seconds (a driver's
// time-out is shorter). The line's speed is set at the server. Errors: kNotFound (no such host),
// kTimeout, kIo.
Result<std::unique_ptr<ByteStream>> openTcp(const std::string& host, const std::string& service);

}  // namespace merlin::io
