#include "drivers/vrpn/client.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>

#include "drivers/port/dialogue.h"

namespace merlin::vrpn {
namespace {

using std::chrono::seconds;

constexpr Duration kCookieTime = seconds(2);
constexpr Duration kOpenTime = seconds(2);
constexpr Duration kPingInterval = seconds(1);  // as in VRPN's clients
constexpr Duration kLongestSilence = seconds(3);
constexpr std::size_t kMostOthers = 8;  // names of other devices that a message lists

// The client's numbers for its senders and for the types that every client has; the numbers of the
// driver's own types follow.
enum Sender : std::int32_t { kControl, kDevice };
enum Type : std::int32_t { kPing, kPong, kFirstOwn };

}  // namespace

Client::Client(std::string device, std::span<const char* const> types, const Clock& clock,
               Listener& listener)
    : name_(std::move(device)), types_(types), clock_(clock), listener_(listener) {
  assert(types.size() <= kMostTypes);
}

bool Client::knowsAType() const noexcept {
  return std::ranges::any_of(type_, [](const auto& number) { return number.has_value(); });
}

Result<std::string> Client::open(ByteStream& stream, const std::function<const char*()>& lacks) {
  restart();
  Dialogue dialogue(stream, clock_);
  if (const auto sent = dialogue.send(vrpnCookie()); !sent) return sent.error();
  const auto cookie = dialogue.readExactly(kVrpnCookieLength, kCookieTime, "VRPN's greeting");
  if (!cookie) return cookie.error();
  if (const auto fits = checkGreeting(*cookie); !fits) return fits.error();
  if (const auto sent = dialogue.send(introduction()); !sent) return sent.error();
  opening_ = true;
  const auto complete = await(stream, lacks);
  opening_ = false;
  if (!complete) return complete.error();
  return std::string(vrpnVersion(*cookie));
}

void Client::restart() noexcept {
  parser_.reset();
  device_.reset();
  type_ = {};
  others_.clear();
  sequence_ = 0;
  heard_ = clock_.now();
}

// Returns the descriptions of the client's senders and types. A server answers a ping only if the
// ping's sender has the name of one of the server's devices.
std::string Client::introduction() {
  std::string bytes;
  const auto describe = [&](std::int32_t what, std::int32_t number, std::string_view name) {
    VrpnHeader header;
    header.sender = number;
    header.type = what;
    header.sequence = sequence_++;
    appendVrpn(header, vrpnName(name), bytes);
  };
  describe(kVrpnDescribeSender, kControl, kVrpnControl);
  describe(kVrpnDescribeSender, kDevice, name_);
  describe(kVrpnDescribeType, kPing, kVrpnPing);
  describe(kVrpnDescribeType, kPong, kVrpnPong);
  std::int32_t number = kFirstOwn;
  for (const char* const type : types_) describe(kVrpnDescribeType, number++, type);
  return bytes;
}

Result<Ok> Client::await(ByteStream& stream, const std::function<const char*()>& lacks) {
  if (const auto pinged = ping(stream); !pinged) return pinged;
  const Timestamp until = clock_.now() + kOpenTime;
  for (;;) {
    const std::string_view lacking = lacks();
    if (lacking.empty()) return Ok{};
    const Duration left = until - clock_.now();
    if (left <= Duration::zero() && !device_) return unknownDevice();
    if (left <= Duration::zero())
      return Error{Errc::kTimeout, fmt::format("\"{}\": {}", name_, lacking)};
    if (auto received = receive(stream, std::min(left, kPollTime)); !received) return received;
  }
}

Error Client::unknownDevice() const {
  const std::string others =
      others_.empty() ? "no device" : fmt::format("\"{}\"", fmt::join(others_, "\", \""));
  return {Errc::kMalformed, fmt::format("the server has no \"{}\"; it has {}{}", name_, others,
                                        others_.size() < kMostOthers ? "" : " ...")};
}

Result<Ok> Client::poll(ByteStream& stream, Duration wait) {
  if (auto received = receive(stream, wait); !received) return received;
  const Timestamp now = clock_.now();
  if (const Duration silence = now - heard_; silence >= kLongestSilence) {
    return Error{Errc::kTimeout,
                 fmt::format("the server has sent nothing for {:.1f} s", toSeconds(silence))};
  }
  if (now - pinged_ < kPingInterval) return Ok{};
  return ping(stream);
}

Result<Ok> Client::ping(ByteStream& stream) {
  pinged_ = clock_.now();
  VrpnHeader header;
  header.sender = kDevice;
  header.type = kPing;
  header.sequence = sequence_++;
  ping_.clear();  // keeps its memory
  appendVrpn(header, {}, ping_);
  const auto written = stream.write(std::as_bytes(std::span(ping_)), kPollTime);
  if (!written) return written.error();
  return Ok{};
}

Result<Ok> Client::receive(ByteStream& stream, Duration timeout) {
  std::array<std::byte, 1024> buffer;  // NOLINT(*-member-init): filled by read
  const auto got = stream.read(buffer, timeout);
  if (!got && got.error().code != Errc::kTimeout) return got.error();
  if (!got) return Ok{};
  heard_ = clock_.now();
  for (std::size_t i = 0; i < *got; ++i) {
    if (!parser_.inside()) message_start_ = heard_;
    const auto message = takeByte(parser_, buffer[i]);
    if (parser_.broken()) ++bad_packets_;
    if (!message) return message.error();
    if (*message) handle(**message);
  }
  return Ok{};
}

void Client::handle(const Message& message) {
  const VrpnHeader& header = message.header;
  if (header.type == kVrpnDescribeSender) return describeSender(message);
  if (header.type == kVrpnDescribeType) return describeType(message);
  if (header.type < 0 || header.sender != device_) return;
  const auto* const type = std::find(type_.begin(), type_.end(), header.type);
  if (type == type_.end()) return;
  const auto index = static_cast<std::size_t>(type - type_.begin());
  if (!listener_.take(index, message.payload, message_start_)) ++bad_packets_;
}

// Takes the description of a sender. If the server gives the device's number a new name, the number
// no longer denotes the device.
void Client::describeSender(const Message& message) {
  const std::int32_t number = message.header.sender;
  const auto name = readVrpnName(message.payload);
  if (!name) ++bad_packets_;
  if (name == name_) {
    device_ = number;
    return;
  }
  if (device_ == number) device_.reset();
  if (opening_ && name && *name != kVrpnControl && others_.size() < kMostOthers)
    others_.push_back(quoteBytes(*name));
}

void Client::describeType(const Message& message) noexcept {
  const std::int32_t number = message.header.sender;
  const auto name = readVrpnName(message.payload);
  if (!name) ++bad_packets_;
  for (std::size_t i = 0; i < types_.size(); ++i) {
    if (name == types_[i])
      type_[i] = number;
    else if (type_[i] == number)
      type_[i].reset();
  }
}

}  // namespace merlin::vrpn
