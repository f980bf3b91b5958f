#include "drivers/fastrak/device.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace merlin::fastrak {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kPollTime = milliseconds(250);
constexpr Duration kQuiet = milliseconds(200);  // a record is over by then, at any speed
constexpr Duration kReplyTime = milliseconds(400);
constexpr Duration kMostDrain = seconds(1);
constexpr Duration kPatience = milliseconds(1200);  // of an open(): the box is asked again for this
constexpr Duration kStartTime = seconds(10);        // of a box that was reinitialised
constexpr Duration kSettleTime = milliseconds(50);  // VRPN's pause after each output list
// Longer than five periods of the slowest stream, 30 records a second at 9600 baud.
constexpr Duration kLongestSilence = milliseconds(500);

constexpr int kFailuresBeforeRestart = 4;  // of open(), in a row

constexpr std::string_view kReinitialise = "\x19";
constexpr std::string_view kStop = "c";

constexpr char kComplaint[] = "station 1 reports error k";
constexpr std::size_t kComplaintStation = 8, kComplaintLetter = 24;

constexpr float kMetresPerInch = 0.0254F;
constexpr float kMetresPerCentimetre = 0.01F;

// The line works, and what is on it did not answer, or not as a Fastrak does.
bool isOfTheBox(const Error& error) noexcept {
  return error.code == Errc::kTimeout || error.code == Errc::kMalformed;
}

}  // namespace

FastrakDevice::FastrakDevice(const FastrakSettings& settings, const Clock& clock, SampleSink& sink)
    : settings_(settings), clock_(clock), sink_(sink) {}

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
  // Rarely: a box that has only been out of reach for a while would be deaf for ten seconds more.
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
  parser_.reset();
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
  return Error{Errc::kMalformed, fmt::format("\"{}\" in answer to S", quoteBytes(*reply))};
}

Result<Stations> FastrakDevice::askStations(Dialogue& dialogue) {
  if (const auto sent = dialogue.send("l1\r"); !sent) return sent.error();
  const auto reply = dialogue.readExactly(kStationsLength, kReplyTime, "l1");
  if (!reply) return reply.error();
  const auto stations = parseStations(*reply);
  if (!stations) {
    return Error{Errc::kMalformed, fmt::format("\"{}\" in answer to l1", quoteBytes(*reply))};
  }
  if (*stations == Stations{}) {
    failures_ = kFailuresBeforeRestart - 1;  // it looks for receivers when it starts
    return Error{Errc::kMalformed, "no station is active: is a receiver plugged in?"};
  }
  return *stations;
}

// Nothing here is answered; a command error is drained, and then shows in what streams.
Result<Ok> FastrakDevice::setUp(Dialogue& dialogue, const Stations& stations) {
  for (std::size_t i = 0; i < kStations; ++i) {
    if (!stations[i]) continue;
    const auto& h = settings_.hemisphere[i];
    const auto commands =
        fmt::format("H{0},{1:.4g},{2:.4g},{3:.4g}\rO{0},2,11,0\r", i + 1, h[0], h[1], h[2]);
    if (auto sent = dialogue.send(commands); !sent) return sent;
    if (const auto quiet = dialogue.drain(kSettleTime, kSettleTime); !quiet) return quiet.error();
  }
  return dialogue.send(settings_.centimetres ? "ufC" : "UfC");
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
  for (std::size_t i = 0; i < 4; ++i) sample.orientation_wxyz[i] = q[i] / norm;
  const bool news = sample.error != record.error;
  sample.error = record.error;
  if (news) noteErrors();
  ++samples_;
  sink_.publish(sample);
}

// Of the first station that has an error, so that it does not flicker where another is well.
void FastrakDevice::noteErrors() noexcept {
  complaint_[0] = '\0';
  for (const TrackerSample& sample : sample_) {
    if (sample.error == ' ' || complaint_[0]) continue;
    std::copy(std::begin(kComplaint), std::end(kComplaint), complaint_);
    complaint_[kComplaintStation] = static_cast<char>('0' + sample.station);
    complaint_[kComplaintLetter] = sample.error;
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
