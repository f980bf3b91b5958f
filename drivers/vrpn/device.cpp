#include "drivers/vrpn/device.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "drivers/port/dialogue.h"
#include "drivers/port/plausible.h"

namespace merlin::vrpn {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kCookieTime = seconds(2);
constexpr Duration kPoseTime = seconds(2);
constexpr Duration kPollTime = milliseconds(250);
constexpr Duration kPingInterval = seconds(1);  // as VRPN's clients ping
constexpr Duration kLongestSilence = seconds(3);
constexpr std::size_t kMostOthers = 8;  // names of other devices that a message lists

// Our numbers for senders and types.
enum Sender : std::int32_t { kControl, kDevice };
enum Type : std::int32_t { kPing, kPong, kPose };
constexpr const char* kTypes[] = {kVrpnPing, kVrpnPong, kVrpnPoseType};

constexpr const char* kNoneCame = "the server has the device, but no pose of it comes";
constexpr const char* kOtherSensors = "poses come only of sensors that \"stations\" does not have";
constexpr const char* kTooFar = "poses come from beyond 25 m: is \"scale\" right?";
constexpr const char* kNoRotation = "the orientations that come are not unit quaternions";

// Why no tracker can have measured this.
const char* faultOf(const TrackerSample& sample) noexcept {
  const auto& p = sample.position_m;
  const bool near =
      std::all_of(std::begin(p), std::end(p), [](float v) { return std::abs(v) <= kFurthest_m; });
  return near ? kNoRotation : kTooFar;
}

void normalise(float (&q)[4]) noexcept {
  const float norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (float& v : q) v /= norm;
}

}  // namespace

VrpnDevice::VrpnDevice(VrpnSettings settings, const Clock& clock, SampleSink& sink)
    : settings_(std::move(settings)), clock_(clock), sink_(sink) {
  for (std::size_t i = 0; i < kStations; ++i) {
    sample_[i].station = static_cast<std::uint32_t>(i + 1);
    sample_[i].error = ' ';
  }
}

Result<std::string> VrpnDevice::open(ByteStream& stream) {
  restart();
  Dialogue dialogue(stream, clock_);
  if (const auto sent = dialogue.send(vrpnCookie()); !sent) return sent.error();
  const auto cookie = dialogue.readExactly(kVrpnCookieLength, kCookieTime, "VRPN's greeting");
  if (!cookie) return cookie.error();
  if (!vrpnCookieFits(*cookie)) {
    return Error{Errc::kMalformed, fmt::format("the greeting \"{}\" is not that of a server of "
                                               "VRPN 7",
                                               quoteBytes(*cookie))};
  }
  if (const auto sent = dialogue.send(introduction()); !sent) return sent.error();
  opening_ = true;
  const auto posed = awaitPose(stream);
  opening_ = false;
  if (!posed) return posed.error();
  return fmt::format("VRPN tracker {} at server version {}", settings_.device,
                     vrpnVersion(*cookie));
}

void VrpnDevice::restart() noexcept {
  parser_.reset();
  device_.reset();
  pose_type_.reset();
  others_.clear();
  sequence_ = 0;
  heard_ = posed_ = clock_.now();
  silence_ = kNoneCame;
  complaint_ = "";
}

// A server answers a ping only if its sender has the name of one of the server's devices.
std::string VrpnDevice::introduction() {
  std::string bytes;
  const auto describe = [&](std::int32_t what, std::int32_t number, std::string_view name) {
    VrpnHeader header;
    header.sender = number;
    header.type = what;
    header.sequence = sequence_++;
    appendVrpn(header, vrpnName(name), bytes);
  };
  describe(kVrpnDescribeSender, kControl, kVrpnControl);
  describe(kVrpnDescribeSender, kDevice, settings_.device);
  for (std::int32_t i = 0; i < std::ssize(kTypes); ++i) describe(kVrpnDescribeType, i, kTypes[i]);
  return bytes;
}

Result<Ok> VrpnDevice::awaitPose(ByteStream& stream) {
  if (const auto pinged = ping(stream); !pinged) return pinged;
  const Timestamp until = clock_.now() + kPoseTime;
  for (const std::uint64_t before = samples_; samples_ == before;) {
    const Duration left = until - clock_.now();
    if (left <= Duration::zero()) return noPose();
    if (auto received = receive(stream, std::min(left, kPollTime)); !received) return received;
  }
  return Ok{};
}

Error VrpnDevice::noPose() const {
  if (device_) return {Errc::kTimeout, fmt::format("\"{}\": {}", settings_.device, silence_)};
  const std::string others =
      others_.empty() ? "no device" : fmt::format("\"{}\"", fmt::join(others_, "\", \""));
  return {Errc::kMalformed, fmt::format("the server has no \"{}\"; it has {}{}", settings_.device,
                                        others, others_.size() < kMostOthers ? "" : " ...")};
}

Result<Ok> VrpnDevice::poll(ByteStream& stream) {
  if (auto received = receive(stream, kPollTime); !received) return received;
  const Timestamp now = clock_.now();
  if (const Duration silence = now - heard_; silence >= kLongestSilence) {
    return Error{Errc::kTimeout,
                 fmt::format("the server has sent nothing for {:.1f} s", toSeconds(silence))};
  }
  complaint_ = now - posed_ < kPoseTime ? "" : silence_;
  if (now - pinged_ < kPingInterval) return Ok{};
  return ping(stream);
}

Result<Ok> VrpnDevice::ping(ByteStream& stream) {
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

Result<Ok> VrpnDevice::receive(ByteStream& stream, Duration timeout) {
  std::array<std::byte, 1024> buffer;  // NOLINT(*-member-init): filled by read
  const auto got = stream.read(buffer, timeout);
  if (!got && got.error().code != Errc::kTimeout) return got.error();
  if (!got) return Ok{};
  heard_ = clock_.now();
  for (std::size_t i = 0; i < *got; ++i) {
    if (!parser_.inside()) message_start_ = heard_;
    const auto message = parser_.feed(buffer[i]);
    if (parser_.broken()) {
      ++bad_packets_;
      return Error{Errc::kMalformed, "the server sent a message with an invalid length"};
    }
    if (!message) continue;
    if (message->header.type == kVrpnDisconnect)
      return Error{Errc::kClosed, "the server has ended the connection"};
    handle(*message);
  }
  return Ok{};
}

void VrpnDevice::handle(const Message& message) {
  const VrpnHeader& header = message.header;
  if (header.type == kVrpnDescribeSender) return describeSender(message);
  if (header.type == kVrpnDescribeType) return describeType(message);
  if (header.type < 0 || header.type != pose_type_ || header.sender != device_) return;
  const auto pose = readVrpnPose(message.payload);
  if (pose && pose->sensor >= 0) return take(*pose);
  ++bad_packets_;
}

// A number that gets another name is not that of our device any more.
void VrpnDevice::describeSender(const Message& message) {
  const std::int32_t number = message.header.sender;
  const auto name = readVrpnName(message.payload);
  if (!name) ++bad_packets_;
  if (name == settings_.device) {
    device_ = number;
    return;
  }
  if (device_ == number) device_.reset();
  if (opening_ && name && *name != kVrpnControl && others_.size() < kMostOthers)
    others_.push_back(quoteBytes(*name));
}

void VrpnDevice::describeType(const Message& message) noexcept {
  const std::int32_t number = message.header.sender;
  const auto name = readVrpnName(message.payload);
  if (!name) ++bad_packets_;
  if (name == kVrpnPoseType) {
    pose_type_ = number;
  } else if (pose_type_ == number) {
    pose_type_.reset();
  }
}

void VrpnDevice::take(const VrpnPose& pose) noexcept {
  const auto& stations = settings_.stations;
  const auto station = std::find(stations.begin(), stations.end(), pose.sensor);
  if (station == stations.end()) {
    silence_ = kOtherSensors;
    return;
  }
  TrackerSample& newest = sample_[static_cast<std::size_t>(station - stations.begin())];
  TrackerSample sample = newest;
  for (std::size_t i = 0; i < 3; ++i)
    sample.position_m[i] = static_cast<float>(settings_.scale * pose.position[i]);
  for (std::size_t i = 0; i < 4; ++i)
    sample.orientation_wxyz[i] = static_cast<float>(pose.orientation_wxyz[i]);
  if (!plausible(sample)) {
    ++bad_packets_;
    silence_ = faultOf(sample);
    return;
  }
  normalise(sample.orientation_wxyz);
  sample.received_ns = toNanoseconds(message_start_);
  ++sample.counter;
  newest = sample;
  ++samples_;
  posed_ = clock_.now();
  silence_ = kNoneCame;
  sink_.publish(sample);
}

std::unique_ptr<Device> makeDevice(const VrpnSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<VrpnDevice>(settings, clock, sink);
}

}  // namespace merlin::vrpn
