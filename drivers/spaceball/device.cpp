#include "drivers/spaceball/device.h"

#include <string_view>

#include <fmt/format.h>

#include "drivers/port/dialogue.h"
#include "drivers/spaceball/calibration.h"

namespace merlin::spaceball {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kPollTime = milliseconds(250);
constexpr Duration kSilenceBeforePing = seconds(2);
constexpr Duration kPingTime = seconds(1);
constexpr Duration kConfirmTime = milliseconds(400);
constexpr int kMostSetUps = 5;                         // attempts without a confirmation
constexpr Duration kQuestionTime = milliseconds(500);  // period of the queries in open()
constexpr Duration kLongestWait = milliseconds(3500);  // a reset takes about 2 s
constexpr Duration kBannerTime = seconds(10);

constexpr std::string_view kReset = "\r@RESET\r";
constexpr std::string_view kPing = "k\r";
constexpr std::string_view kQuestion = "\rhm\rhv\r";

// Returns the version in a line such as "@2 Firmware version 2.63 created on 24-Oct-1997.", here
// "2.63"; empty if there is none.
std::string_view firmwareVersion(std::string_view line) {
  constexpr std::string_view kBefore = "ersion ";
  const auto at = line.find(kBefore);
  if (at == std::string_view::npos) return {};
  line.remove_prefix(at + kBefore.size());
  return line.substr(0, line.find_first_not_of("0123456789."));
}

}  // namespace

SpaceballDevice::SpaceballDevice(const SpaceballSettings& settings, const Clock& clock,
                                 SampleSink& sink)
    : settings_(settings), clock_(clock), sink_(sink) {}

Result<std::string> SpaceballDevice::open(ByteStream& stream) {
  Dialogue dialogue(stream, clock_);
  if (const auto sent = dialogue.send(kReset); !sent) return sent.error();
  const auto firmware = awaitBanner(stream);
  if (!firmware) return firmware.error();
  model_ = modelOf(*firmware);
  set_ups_ = 0;
  complaint_ = "";
  parser_ = {};  // drops half a packet of an earlier connection
  pinged_ = false;
  if (const auto done = setUp(stream); !done) return done.error();
  last_heard_ = clock_.now();
  const std::uint32_t counter = sample_.counter;
  sample_ = {};  // buttons and pushes of an earlier connection have ended
  sample_.counter = counter;
  fresh_ = true;
  return fmt::format("{}, firmware {}", nameOf(model_), *firmware);
}

// Waits for the banner and returns the firmware's version. The banner's lines are "@1 Spaceball
// alive and well after a ... reset." and "@2 Firmware version N created on ...". A ball that missed
// @RESET (it was frozen, or its line was interrupted) may nevertheless work, or even stream, so its
// version is queried every 0.5 s.
Result<std::string> SpaceballDevice::awaitBanner(ByteStream& stream) {
  Dialogue dialogue(stream, clock_);
  const Timestamp start = clock_.now();
  Timestamp heard = start, question = start + kQuestionTime;
  for (Timestamp now = start; now - start < kBannerTime; now = clock_.now()) {
    if (now - heard >= kLongestWait)
      return Error{Errc::kTimeout,
                   fmt::format("no answer to @RESET, nor to hm and hv, within {:.1f} s",
                               toSeconds(kLongestWait))};
    if (now >= question) {
      question = now + kQuestionTime;
      if (const auto sent = dialogue.send(kQuestion); !sent) return sent.error();
    }
    const auto line = dialogue.readUntil('\r', 256, question - now, "@RESET");
    if (!line && line.error().code == Errc::kTimeout) continue;
    if (!line) return line.error();
    heard = clock_.now();
    const std::string version(firmwareVersion(*line));
    if (!version.empty()) return version;
  }
  return Error{Errc::kMalformed, "bytes arrived for 10 s after @RESET, but no Spaceball banner"};
}

Result<Ok> SpaceballDevice::setUp(ByteStream& stream) {
  Dialogue dialogue(stream, clock_);
  const char feel = settings_.cubic ? '?' : '@';
  const char region =
      static_cast<char>(settings_.null_region < 63 ? '@' + settings_.null_region : '?');
  // Binary mode, 50 ms between packets.
  std::string set_up = fmt::format("CB\rN{0}\rFT{1}\rFR{1}\rP@r@r\r", region, feel);
  if (const auto sent = dialogue.send(set_up); !sent) return sent.error();
  confirmed_ = false;
  set_up_at_ = clock_.now();
  std::string on = model_ == Model::k4000 ? "M\r" : "MSSV\r";
  if (settings_.rezero) on += "Z\r";
  if (!settings_.beep.empty()) on += "B" + settings_.beep.substr(0, 16) + "\r";
  return dialogue.send(on + "k\r");
}

Result<Ok> SpaceballDevice::poll(ByteStream& stream) {
  std::array<std::byte, 64> buffer;  // NOLINT: filled by read
  const auto got = stream.read(buffer, untilDue(sink_, clock_.now(), kPollTime));
  if (!got && got.error().code != Errc::kTimeout) return got.error();
  const Timestamp now = clock_.now();
  for (std::size_t i = 0; got && i < *got; ++i) {
    if (!parser_.inside()) packet_start_ = now;
    const auto packet = parser_.feed(buffer[i]);
    if (!packet) continue;
    last_heard_ = now;
    pinged_ = false;
    if (auto done = handle(*packet, packet_start_, stream); !done) return done;
  }
  tickIfDue(sink_, now);
  return keepAlive(stream);  // bytes that do not form a packet count as silence
}

// If the line loses the set-up, the ball answers queries but never sends displacements. So the
// set-up is sent again until the ball confirms it, by the echo of `M` or by a displacement. A ball
// at rest is silent, so after a while the keys are queried, which it always answers.
Result<Ok> SpaceballDevice::keepAlive(ByteStream& stream) {
  const Timestamp now = clock_.now();
  if (!confirmed_ && now - set_up_at_ >= kConfirmTime) {
    if (++set_ups_ >= kMostSetUps)
      return Error{Errc::kTimeout, "it does not confirm that it was switched on"};
    if (auto done = setUp(stream); !done) return done;
  }
  const Duration silence = now - last_heard_;
  if (silence < kSilenceBeforePing) return Ok{};
  if (pinged_ && silence >= kSilenceBeforePing + kPingTime) {
    return Error{Errc::kTimeout,
                 fmt::format("silent for {:.1f} s, and no answer to a ping", toSeconds(silence))};
  }
  if (pinged_) return Ok{};
  pinged_ = true;
  return Dialogue(stream, clock_).send(kPing);
}

Result<Ok> SpaceballDevice::handle(const Packet& packet, Timestamp first_byte, ByteStream& stream) {
  if (const auto* displacement = std::get_if<Displacement>(&packet)) {
    confirmed_ = true;
    calibrate(*displacement, settings_, sample_);
    publish(first_byte);
  } else if (const auto* keys = std::get_if<Keys>(&packet)) {
    if (keys->flx) model_ = Model::k4000;
    const std::uint32_t buttons = buttonsOf(*keys, model_);
    if (buttons == sample_.buttons && !fresh_) return Ok{};  // the answer to a ping
    sample_.buttons = buttons;
    publish(first_byte);
  } else if (std::get<Text>(packet).line.starts_with('M')) {
    confirmed_ = true;
    set_ups_ = 0;
  } else if (std::get<Text>(packet).line.starts_with('E')) {
    complaint_ = meaningOf(std::get<Text>(packet).line);
  } else if (std::get<Text>(packet).line.starts_with("@1")) {
    return setUp(stream);  // it reset by itself (power, watchdog) and lost its set-up
  }
  return Ok{};
}

void SpaceballDevice::publish(Timestamp first_byte) noexcept {
  sample_.received_ns = toNanoseconds(first_byte);
  ++sample_.counter;
  ++samples_;
  fresh_ = false;
  sink_.publish(sample_);
}

DeviceCounters SpaceballDevice::counters() const noexcept {
  return {samples_, parser_.badBytes(), parser_.badPackets()};
}

std::unique_ptr<Device> makeDevice(const SpaceballSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<SpaceballDevice>(settings, clock, sink);
}

}  // namespace merlin::spaceball
