// Client: the dialogue with a VRPN server (greeting, names, pings) for a driver that reads one of
// its devices. The driver interprets the device's messages.
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

// Receives the messages of the device.
class Listener {
 public:
  virtual ~Listener() = default;

  // Takes a message; `type` is the index of its type in Client's list, `first_byte` the arrival of
  // its first byte. Returns false if the payload is invalid, which counts as a bad packet.
  // Allocates nothing.
  virtual bool take(std::size_t type, std::string_view payload, Timestamp first_byte) noexcept = 0;
};

// Thread-bound: part of a driver, and used on its thread.
class Client {
 public:
  static constexpr std::size_t kMostTypes = 4;
  static constexpr Duration kPollTime = std::chrono::milliseconds(250);  // as Device::poll() allows

  // `device`: its name at the server. `types`: names of the messages that are read, at most
  // kMostTypes; they must outlive the client, and so must `clock` and `listener`.
  Client(std::string device, std::span<const char* const> types, const Clock& clock,
         Listener& listener);

  // Greets the server and reads until `lacks()`, which names what is still missing, returns an
  // empty text; returns the server's version. Takes at most 4 s. Errors: kMalformed (not a server
  // of VRPN 7, or it has no device of this name), kTimeout (with the text that `lacks()` still
  // returns), and those of the stream.
  Result<std::string> open(ByteStream& stream, const std::function<const char*()>& lacks);

  // Passes the messages that arrive within `wait` to the listener, and pings the server each
  // second. Errors: kTimeout (no byte for 3 s), kClosed (the server has ended the connection),
  // kMalformed, and those of the stream. Allocates nothing, unless it fails.
  Result<Ok> poll(ByteStream& stream, Duration wait = kPollTime);

  // knowsDevice() returns whether the server has described the device, knowsAType() whether it has
  // described any of the types.
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

  std::string name_;  // name of the device
  std::span<const char* const> types_;
  const Clock& clock_;
  Listener& listener_;
  Parser parser_;
  // The server's numbers of the device and of the types (by index in types_), as it described them
  // last.
  std::optional<std::int32_t> device_;
  std::array<std::optional<std::int32_t>, kMostTypes> type_;
  std::vector<std::string> others_;  // other devices that were described during open()
  bool opening_ = false;
  std::uint64_t bad_packets_ = 0;
  std::uint32_t sequence_ = 0;  // number of the next message to the server
  std::string ping_;
  Timestamp message_start_{}, heard_{}, pinged_{};
};

}  // namespace merlin::vrpn
