// `tcp://HOST:PORT`: a raw serial server (ser2net, a terminal server) as a device's line.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

// Connects within a second, without delay of small packets; a server that vanishes without a word
// is noticed within about five seconds (a device's own watchdog is sooner). The line's speed is the
// server's matter. Errors: kNotFound (no such host), kTimeout, kIo.
Result<std::unique_ptr<ByteStream>> openTcp(const std::string& host, const std::string& service);

}  // namespace merlin::io
