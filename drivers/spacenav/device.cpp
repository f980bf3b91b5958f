#include "drivers/spacenav/device.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>
#include <utility>

#include "drivers/port/dialogue.h"

namespace merlin::spacenav {
namespace {

using std::chrono::milliseconds;

constexpr Duration kHelloTime = milliseconds(300);  // as libspnav waits
constexpr Duration kNameTime = milliseconds(1000);
constexpr std::size_t kLongestName = 256;
constexpr std::uint32_t kButtons = 12;  // those of BallSample
constexpr const char* kNoMouse = "spacenavd has no space mouse";

}  // namespace

Result<std::string> SpacenavDevice::open(ByteStream& stream) {
  parser_.reset();
  ball_.restart();
  mouse_lost_ = false;
  if (const auto greeted = greet(stream); !greeted) return greeted.error();
  auto name = has_names_ ? askName(stream) : Result<std::string>(std::string("space mouse"));
  if (name) ball_.settle(clock_.now());
  return name;
}

// Sends the word with which version 1 begins. A spacenavd of version 0 interprets this word as a
// sensitivity, which is then NaN; therefore the sensitivity is set to 1 afterwards, as libspnav
// does.
Result<Ok> SpacenavDevice::greet(ByteStream& stream) {
  Dialogue dialogue(stream, clock_);
  if (auto sent = dialogue.send(encodeWord(kHello)); !sent) return sent;
  const auto answer = dialogue.readExactly(sizeof kHello, kHelloTime, "the greeting");
  if (!answer && answer.error().code != Errc::kTimeout) return answer.error();
  has_names_ = answer && *answer == encodeWord(kHello);
  if (has_names_) return Ok{};
  if (answer) {  // version 0: this is the beginning of an event
    frame_start_ = clock_.now();
    for (const char c : *answer) (void)parser_.feed(static_cast<std::byte>(c));
  }
  return dialogue.send(encodeWord(std::bit_cast<std::uint32_t>(1.0F)));
}

// Events may arrive between the pieces of the answer.
Result<std::string> SpacenavDevice::askName(ByteStream& stream) {
  Dialogue dialogue(stream, clock_);
  if (const auto sent = dialogue.send(encode({kDeviceName})); !sent) return sent.error();
  const Timestamp until = clock_.now() + kNameTime;
  std::string name;
  while (clock_.now() < until && name.size() < kLongestName) {
    const auto bytes =
        dialogue.readExactly(sizeof(Frame), until - clock_.now(), "the question for its name");
    if (!bytes) return bytes.error();
    for (const char c : *bytes) {
      const auto frame = parser_.feed(static_cast<std::byte>(c));
      if (!frame) continue;
      handle(*frame, clock_.now());
      if ((*frame)[0] != kDeviceName) continue;
      const auto piece = namePiece(*frame);
      mouse_lost_ = !piece;
      if (!piece) return std::string("space mouse");
      name += piece->text;
      if (piece->complete) return name.empty() ? std::string("space mouse") : name;
    }
  }
  return Error{Errc::kMalformed, "spacenavd does not answer the question for its device's name"};
}

Result<Ok> SpacenavDevice::poll(ByteStream& stream) {
  std::array<std::byte, 16 * sizeof(Frame)> buffer;  // NOLINT(*-member-init): filled by read
  const auto got = stream.read(buffer, ball_.wait(clock_.now()));
  const Timestamp now = clock_.now();
  if (!got && got.error().code != Errc::kTimeout) return got.error();
  for (std::size_t i = 0; got && i < *got; ++i) {
    if (!parser_.inside()) frame_start_ = now;
    if (const auto frame = parser_.feed(buffer[i])) handle(*frame, frame_start_);
  }
  ball_.hold(now);
  return Ok{};
}

void SpacenavDevice::handle(const Frame& frame, Timestamp first_byte) noexcept {
  switch (frame[0]) {
    case kMotion:
      mouse_lost_ = false;  // spacenavd reads several mice: the removed one was not the last
      move(frame);
      break;
    case kPress: mouse_lost_ = false; [[fallthrough]];
    case kRelease: {
      const auto number = static_cast<std::uint32_t>(frame[1]);
      if (number >= kButtons) return;
      std::uint32_t& buttons = ball_.sample().buttons;
      buttons = frame[0] == kPress ? buttons | 1U << number : buttons & ~(1U << number);
      break;
    }
    case kDevice: {  // pushes and pressed buttons have ended
      constexpr std::int32_t kAdded = 0;
      mouse_lost_ = frame[1] != kAdded;
      ball_.restart();
      break;
    }
    default: return;
  }
  ball_.publish(first_byte);
}

void SpacenavDevice::move(const Frame& frame) noexcept {
  using Raw = std::numeric_limits<std::int16_t>;
  BallSample& sample = ball_.sample();
  std::array<float, 6> counts{};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const std::int32_t raw = std::clamp<std::int32_t>(frame[i + 1], Raw::min(), Raw::max());
    sample.raw[i] = static_cast<std::int16_t>(raw);
    counts[i] = static_cast<float>(raw);
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const int source = settings_.axis_map[i];
    const float count = counts[static_cast<std::size_t>(std::abs(source) - 1)];
    const float share =
        axisShare(source < 0 ? -count : count, static_cast<float>(settings_.dead_zone),
                  static_cast<float>(settings_.full_scale));
    (i < 3 ? sample.translation[i] : sample.rotation[i - 3]) = share;
  }
}

DeviceCounters SpacenavDevice::counters() const noexcept {
  return {ball_.samples(), parser_.badBytes(), parser_.badPackets()};
}

const char* SpacenavDevice::complaint() const noexcept { return mouse_lost_ ? kNoMouse : ""; }

std::unique_ptr<Device> makeDevice(const SpacenavSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<SpacenavDevice>(settings, clock, sink);
}

}  // namespace merlin::spacenav
