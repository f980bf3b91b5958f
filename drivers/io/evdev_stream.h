// EvdevStream: an input device of the kernel as a ByteStream of drivers/port/evdev_line.h's
// records.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

// Opens the device and grabs it, so that nobody else gets its events; its description is read
// first. Errors: kNotFound, kBusy (another program has grabbed it), kIo (without permission, the
// message names the group to join; not an input device). write() of the stream always fails with
// kIo.
Result<std::unique_ptr<ByteStream>> openEvdev(const std::string& path);

}  // namespace merlin::io
