// EvdevStream: an input device of the kernel as a ByteStream of drivers/port/evdev_line.h's
// records.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"
#include "drivers/port/evdev_line.h"

struct libevdev;

namespace merlin::io {

// Opens the device and grabs it, so that no other program gets its events. The stream begins with
// the device's description. Errors: kNotFound (no such file, or the device was unplugged before it
// was grabbed), kBusy (another program has grabbed it), kIo (not an input device, or no permission:
// then the message names the group to join). write() of the stream always fails with kIo; read()
// fails with kClosed once the device is unplugged.
Result<std::unique_ptr<ByteStream>> openEvdev(const std::string& path);

// The requests that openEvdev() makes to the kernel for an open file. Each call returns 0 or a
// negative errno value.
struct EvdevRequests {
  std::function<int(int fd, libevdev** device)> describe;  // makes `device` if it returns 0
  std::function<int(libevdev* device)> grab;
};

// Opens the device with other requests to the kernel; for tests, which cannot unplug a device at a
// chosen moment.
Result<std::unique_ptr<ByteStream>> openEvdev(const std::string& path,
                                              const EvdevRequests& requests);

// Returns the record with which such a stream describes the key that has this number in the kernel;
// it includes the key's name.
EvdevRecord keyRecord(std::uint16_t code);

// All numbers of keys and buttons in the kernel are below this.
inline constexpr std::uint16_t kKeyCodes = 0x300;
// Returns the kernel's number of the key or button with this name in lower case, such as
// "key_space" or "btn_south"; nothing if there is none.
std::optional<std::uint16_t> keyCode(std::string_view name);
// Inverse of keyCode(); empty if the number has no name.
std::string keyNameOf(std::uint16_t code);

}  // namespace merlin::io
