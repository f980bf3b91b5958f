// Opens a ByteStream over a local socket at which another program listens, as spacenavd does.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

// Connects to the socket at `path`. Errors: kInvalidArgument (the path is longer than a socket's
// may be), kNotFound (the socket does not exist), kIo (no program listens at it, or permission is
// missing: then the message names the group to join).
Result<std::unique_ptr<ByteStream>> openUnix(const std::string& path);

}  // namespace merlin::io
