// EvdevStream: an input device of the kernel as a ByteStream of drivers/port/evdev_line.h's
// records.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"
#include "drivers/port/evdev_line.h"

namespace merlin::io {

// Opens the device and grabs it, so that nobody else gets its events; its description is read
// first. Errors: kNotFound, kBusy (another program has grabbed it), kIo (without permission, the
// message names the group to join; not an input device). write() of the stream always fails with
// kIo.
Result<std::unique_ptr<ByteStream>> openEvdev(const std::string& path);

// The record that describes a key of this number of the kernel, as such a stream has it: with the
// key's name.
EvdevRecord keyRecord(std::uint16_t code);

}  // namespace merlin::io
