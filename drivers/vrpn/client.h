// Client: the dialogue with a VRPN server, of which a driver reads one device: greeting, names,
// pings. What the device's messages mean is for the driver.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/clock.h"
#include "drivers/port/byte_stream.h"
#include "drivers/vrpn/protocol.h"

namespace merlin::vrpn {

// Takes the messages of the device.
class Listener {
 public:
  virtual ~Listener() = default;

  // A message of the type whose index in Client's list this is; its first byte came at
  // `first_byte`. Returns whether it is one that such a device can send; if not, it counts as a bad
  // packet. Allocates nothing.
  virtual bool take(std::size_t type, std::string_view payload, Timestamp first_byte) noexcept = 0;
};

// As thread-bound as the driver, of which it is a part.
class Client {
 public:
  static constexpr std::size_t kMostTypes = 4;
  static constexpr Duration kPollTime = std::chrono::milliseconds(250);  // as Device::poll() allows

  // `device`: its name at the server. `types`: names of the messages that are read, at most
  // kMostTypes; they have to outlive the client, as do `clock` and `listener`.
  Client(std::string device, std::span<const char* const> types, const Clock& clock,
         Listener& listener);

  // Greets the server and reads until `lacks()` returns an empty text; returns the server's
  // version. Takes at most 4 s. Errors: kMalformed (no server of VRPN 7, or it has no device of
  // this name), kTimeout (with the text that `lacks()` still returns), and those of the stream.
  Result<std::string> open(ByteStream& stream, const std::function<const char*()>& lacks);

  // Gives the listener what arrives within `wait`, and pings the server each second. Errors:
  // kTimeout (not a byte for 3 s), kClosed (the server has ended the connection), kMalformed, and
  // those of the stream. Allocates nothing, unless it fails.
  Result<Ok> poll(ByteStream& stream, Duration wait = kPollTime);

  // Whether the server has described the device, and any of the types.
  bool knowsDevice() const noexcept { return device_.has_value(); }
  bool knowsAType() const noexcept;
  std::uint64_t badPackets() const noexcept { return bad_packets_; }

 private:
  void restart() noexcept;
  std::string introduction();
  Result<Ok> await(ByteStream& stream, const std::function<const char*()>& lacks);
  Error unknownDevice() const;
  Result<Ok> receive(ByteStream& stream, Duration timeout);
  Result<Ok> ping(ByteStream& stream);
  void handle(const Message& message);
  void describeSender(const Message& message);
  void describeType(const Message& message) noexcept;

  std::string name_;  // of the device
  std::span<const char* const> types_;
  const Clock& clock_;
  Listener& listener_;
  Parser parser_;
  // The server's numbers, as it described them last; by index in types_.
  std::optional<std::int32_t> device_;
  std::array<std::optional<std::int32_t>, kMostTypes> type_;
  std::vector<std::string> others_;  // devices of other names that were described during open()
  bool opening_ = false;
  std::uint64_t bad_packets_ = 0;
  std::uint32_t sequence_ = 0;  // of the messages to the server
  std::string ping_;
  Timestamp message_start_{}, heard_{}, pinged_{};
};

}  // namespace merlin::vrpn
