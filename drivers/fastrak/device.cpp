#include "drivers/fastrak/device.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "drivers/port/plausible.h"

namespace merlin::fastrak {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kPollTime = milliseconds(250);
// If no byte arrives for this time, no record is being sent.
constexpr Duration kQuiet = milliseconds(200);
constexpr Duration kReplyTime = milliseconds(400);
constexpr Duration kMostDrain = seconds(1);
constexpr Duration kPatience = milliseconds(1200);  // time for which open() repeats its query
// Time for which open() repeats its query after a reinitialisation.
constexpr Duration kStartTime = seconds(10);
constexpr Duration kSettleTime = milliseconds(50);  // wait after each output list, as in VRPN
// Longer than five periods of a slow stream, 30 records per second at 9600 baud.
constexpr Duration kLongestSilence = milliseconds(500);

constexpr int kFailuresBeforeRestart = 4;  // consecutive failures of open()

constexpr std::string_view kReinitialise = "\x19";
constexpr std::string_view kStop = "c";

constexpr float kMetresPerInch = 0.0254F;
constexpr float kMetresPerCentimetre = 0.01F;

// Returns the orientation relative to the one that counts as straight ahead: q * conj(ahead).
std::array<float, 4> ofBoresight(const std::array<float, 4>& q, const std::array<float, 4>& a) {
  if (a == FastrakSettings::kAhead) return q;
  return {q[0] * a[0] + q[1] * a[1] + q[2] * a[2] + q[3] * a[3],
          -q[0] * a[1] + q[1] * a[0] - q[2] * a[3] + q[3] * a[2],
          -q[0] * a[2] + q[1] * a[3] + q[2] * a[0] - q[3] * a[1],
          -q[0] * a[3] - q[1] * a[2] + q[2] * a[1] + q[3] * a[0]};
}

// Returns the largest coordinate that a record can have, in the unit of the line: the reach of a
// receiver, plus the distance of the farthest configured origin from the transmitter, plus the
// length of a stylus.
float furthestOf(const FastrakSettings& settings) {
  float origin_cm = 0, tip_cm = 0;
  for (const auto& a : settings.alignment_cm)
    origin_cm = std::max(origin_cm, std::hypot(a[0], a[1], a[2]));
  const auto& t = settings.stylus_tip_cm;
  if (settings.stylus) tip_cm = std::hypot(t[0], t[1], t[2]);
  const float cm = kTrackerReach_m / kMetresPerCentimetre + origin_cm + tip_cm;
  return settings.centimetres ? cm : cm * kMetresPerCentimetre / kMetresPerInch;
}

// Returns whether the fault lies in the unit and not in the line, that is, whether there was no
// answer or not that of a Fastrak.
bool isOfTheBox(const Error& error) noexcept {
  return error.code == Errc::kTimeout || error.code == Errc::kMalformed;
}

}  // namespace

FastrakDevice::FastrakDevice(const FastrakSettings& settings, const Clock& clock, SampleSink& sink)
    : settings_(settings),
      clock_(clock),
      sink_(sink),
      layout_{static_cast<Layout::Numbers>(settings.numbers), settings.angles, settings.stylus,
              settings.centimetres, furthestOf(settings)} {}

Result<std::string> FastrakDevice::open(ByteStream& stream) {
  Dialogue dialogue(stream, clock_);
  for (TrackerSample& sample : sample_) sample.error = ' ';
  complaint_[0] = '\0';
  auto identity = talk(dialogue);
  if (identity) {
    failures_ = 0;
  } else if (isOfTheBox(identity.error())) {
    ++failures_;
  }
  return identity;
}

Result<std::string> FastrakDevice::talk(Dialogue& dialogue) {
  // Restarts only after several failures, because a unit that was only disconnected would then
  // ignore its input for another 10 s.
  const bool restart = failures_ > 0 && failures_ % kFailuresBeforeRestart == 0;
  const Timestamp deadline = clock_.now() + (restart ? kStartTime : kPatience);
  if (restart) {
    if (const auto sent = dialogue.send(kReinitialise); !sent) return sent.error();
  }
  auto status = identify(dialogue);
  while (!status && isOfTheBox(status.error()) && clock_.now() < deadline) {
    status = identify(dialogue);
  }
  if (!status) return status.error();
  const auto stations = askStations(dialogue);
  if (!stations) return stations.error();
  if (const auto done = setUp(dialogue, *stations); !done) return done.error();
  parser_.expect(layout_);
  last_record_ = clock_.now();
  std::string identity = fmt::format("Fastrak, firmware {}, stations", status->firmware);
  for (std::size_t i = 0; i < kStations; ++i) {
    if ((*stations)[i]) identity += fmt::format(" {}", i + 1);
  }
  return identity;
}

Result<Status> FastrakDevice::identify(Dialogue& dialogue) {
  if (const auto sent = dialogue.send(kStop); !sent) return sent.error();
  if (const auto quiet = dialogue.drain(kQuiet, kMostDrain); !quiet) return quiet.error();
  if (const auto sent = dialogue.send("S"); !sent) return sent.error();
  const auto reply = dialogue.readExactly(kStatusLength, kReplyTime, "S");
  if (!reply) return reply.error();
  const auto status = parseStatus(*reply);
  if (status) return *status;
  return Error{Errc::kMalformed, fmt::format("unexpected answer \"{}\" to S", quoteBytes(*reply))};
}

Result<Stations> FastrakDevice::askStations(Dialogue& dialogue) {
  if (const auto sent = dialogue.send("l1\r"); !sent) return sent.error();
  const auto reply = dialogue.readExactly(kStationsLength, kReplyTime, "l1");
  if (!reply) return reply.error();
  const auto stations = parseStations(*reply);
  if (!stations) {
    return Error{Errc::kMalformed,
                 fmt::format("unexpected answer \"{}\" to l1", quoteBytes(*reply))};
  }
  if (*stations == Stations{}) {
    // Restart the unit, which detects receivers when it starts.
    failures_ = kFailuresBeforeRestart - 1;
    return Error{Errc::kMalformed, "no station is active: is a receiver plugged in?"};
  }
  return *stations;
}

// The unit does not answer these commands; error replies are drained, so a wrong command shows only
// in the records. Alignment commands accumulate in the unit, so the alignment is reset first.
Result<Ok> FastrakDevice::setUp(Dialogue& dialogue, const Stations& stations) {
  if (auto sent = dialogue.send(settings_.centimetres ? "u" : "U"); !sent) return sent;
  for (std::size_t i = 0; i < kStations; ++i) {
    if (!stations[i]) continue;
    if (auto sent = dialogue.send(stationSetUp(i)); !sent) return sent;
    if (const auto quiet = dialogue.drain(kSettleTime, kSettleTime); !quiet) return quiet.error();
  }
  const auto filter = [](char letter, const std::array<float, 4>& f) {
    return fmt::format("{}{:.4g},{:.4g},{:.4g},{:.4g}\r", letter, f[0], f[1], f[2], f[3]);
  };
  const FastrakSettings defaults;
  std::string last;
  if (settings_.position_filter != defaults.position_filter)
    last += filter('x', settings_.position_filter);
  if (settings_.angle_filter != defaults.angle_filter) last += filter('v', settings_.angle_filter);
  return dialogue.send(last + (settings_.numbers == FastrakSettings::Numbers::kText ? "FC" : "fC"));
}

std::string FastrakDevice::stationSetUp(std::size_t i) const {
  const int station = static_cast<int>(i) + 1;
  const auto& h = settings_.hemisphere[i];
  std::string commands = fmt::format("H{},{:.4g},{:.4g},{:.4g}\r", station, h[0], h[1], h[2]);
  commands += fmt::format("R{}\r", station);  // resets the alignment
  if (settings_.alignment_cm[i] != FastrakSettings::kAligned) {
    const float unit = settings_.centimetres ? 1.0F : 1 / 2.54F;
    commands += fmt::format("A{}", station);
    for (const float v : settings_.alignment_cm[i]) commands += fmt::format(",{:.2f}", v * unit);
    commands += '\r';
  }
  Layout layout = layout_;
  if (settings_.stylus && station == 1) {
    const auto& tip = settings_.stylus_tip_cm;
    const float unit = settings_.centimetres ? 1.0F : 1 / 2.54F;
    commands +=
        fmt::format("e1,0\rN1,{:.2f},{:.2f},{:.2f}\r", tip[0] * unit, tip[1] * unit, tip[2] * unit);
  }
  return commands + fmt::format("O{},{}\r", station, layout.items());
}

Result<Ok> FastrakDevice::poll(ByteStream& stream) {
  std::array<std::byte, 256> buffer;  // NOLINT: filled by read
  const auto got = stream.read(buffer, kPollTime);
  if (!got && got.error().code != Errc::kTimeout) return got.error();
  const Timestamp now = clock_.now();
  for (std::size_t i = 0; got && i < *got; ++i) {
    const auto record = parser_.feed(buffer[i], toNanoseconds(now));
    if (!record) continue;
    last_record_ = now;
    publish(*record);
  }
  const Duration silence = now - last_record_;
  if (silence < kLongestSilence) return Ok{};
  return Error{Errc::kTimeout, fmt::format("no record for {:.1f} s", toSeconds(silence))};
}

void FastrakDevice::publish(const Record& record) noexcept {
  const float scale = settings_.centimetres ? kMetresPerCentimetre : kMetresPerInch;
  const auto& q = record.orientation_wxyz;
  const float norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  TrackerSample& sample = sample_[static_cast<std::size_t>(record.station - 1)];
  sample.received_ns = record.received_ns;
  ++sample.counter;
  sample.station = static_cast<std::uint32_t>(record.station);
  for (std::size_t i = 0; i < 3; ++i) sample.position_m[i] = scale * record.position[i];
  const auto ahead =
      ofBoresight({q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm},
                  settings_.boresight_wxyz[static_cast<std::size_t>(record.station - 1)]);
  std::copy(ahead.begin(), ahead.end(), sample.orientation_wxyz);
  sample.stylus = record.stylus ? 1 : 0;
  const bool news = sample.error != record.error;
  sample.error = record.error;
  if (news) noteErrors();
  ++samples_;
  sink_.publish(sample);
}

// Notes the error of the first station that has one, so that the text does not flicker if another
// station works.
void FastrakDevice::noteErrors() noexcept {
  complaint_[0] = '\0';
  for (const TrackerSample& sample : sample_) {
    if (sample.error == ' ' || complaint_[0]) continue;
    const std::string_view meaning = meaningOf(sample.error);
    const auto end = meaning.empty() ? fmt::format_to_n(complaint_, sizeof complaint_ - 1,
                                                        "station {} reports error {}",
                                                        sample.station, sample.error)
                                     : fmt::format_to_n(complaint_, sizeof complaint_ - 1,
                                                        "station {} reports error {} ({})",
                                                        sample.station, sample.error, meaning);
    *end.out = '\0';
  }
}

DeviceCounters FastrakDevice::counters() const noexcept {
  return {samples_, parser_.badBytes(), parser_.badPackets()};
}

std::unique_ptr<Device> makeDevice(const FastrakSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<FastrakDevice>(settings, clock, sink);
}

}  // namespace merlin::fastrak
