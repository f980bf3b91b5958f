// EvdevStream: an input device of the kernel as a ByteStream of drivers/port/evdev_line.h's
// records.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"
#include "drivers/port/evdev_line.h"

namespace merlin::io {

// Opens the device and grabs it, so that nobody else gets its events; its description is read
// first. Errors: kNotFound, kBusy (something else has grabbed it), kIo (without permission, the
// message names the group to join; not an input device). write() of the stream always fails with
// kIo.
Result<std::unique_ptr<ByteStream>> openEvdev(const std::string& path);

// The record that describes a key of this number of the kernel, as such a stream has it: with the
// key's name.
EvdevRecord keyRecord(std::uint16_t code);

// The kernel's numbers of keys and buttons are below this.
inline constexpr std::uint16_t kKeyCodes = 0x300;
// The kernel's number of a key or button by its name in lower case, "key_space" or "btn_south";
// nothing if it has none of that name.
std::optional<std::uint16_t> keyCode(std::string_view name);
// The name of this number, as above; empty if it has none.
std::string keyNameOf(std::uint16_t code);

}  // namespace merlin::io
