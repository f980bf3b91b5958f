#include "drivers/cyberglove/device.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "drivers/cyberglove/calibration.h"
#include "drivers/cyberglove/text.h"

namespace merlin::cyberglove {
namespace {

using std::chrono::milliseconds;

constexpr Duration kPollTime = milliseconds(250);
constexpr Duration kReplyTime = milliseconds(300);
constexpr Duration kLongestSilence = milliseconds(500);
constexpr std::size_t kLongestText = 512;

constexpr double kStampClock = 115200;  // clock of the time stamps [Hz]
constexpr double kMostLost = 1000;      // records; a larger gap shows that the unit was restarted

constexpr std::string_view kStop = "\x03";
constexpr const char* kUnplugged = "glove not plugged in";
constexpr const char* kTooFast = "the requested record rate is higher than the glove can measure";

Error noAnswer(std::string_view reply, std::string_view to) {
  return {Errc::kMalformed, fmt::format("unexpected answer \"{}\" to {}", quoteBytes(reply), to)};
}

// Sends a binary command, in the dialogue that is in use, and returns the answer in binary form
// without its NUL. The answer must have `count` bytes and start with `begin`, which also names the
// step in errors.
Result<std::string> exchange(Dialogue& dialogue, bool text, std::string_view command,
                             std::size_t count, std::string_view begin) {
  const std::string bytes = text ? asText(command) + '\r' : std::string(command);
  if (const auto sent = dialogue.send(bytes); !sent) return sent.error();
  auto reply = text ? dialogue.readUntil('\0', kLongestText, kReplyTime, begin)
                    : dialogue.readExactly(count + 1, kReplyTime, begin);
  if (!reply) return reply.error();
  const std::string said = *reply;
  if (text)
    *reply = ofText(said).value_or("");
  else if (said.back() == '\0')
    reply->pop_back();
  if (reply->size() != count || !reply->starts_with(begin)) return noAnswer(said, begin);
  return reply;
}

// Sends the query '?' + `letter` and returns the `count` bytes that follow it in the answer.
Result<std::string> ask(Dialogue& dialogue, bool text, char letter, std::size_t count) {
  const std::string query{'?', letter};
  const auto reply = exchange(dialogue, text, query, 2 + count, query);
  if (!reply) return reply.error();
  return reply->substr(2);
}

// Sends a command and expects its letter as the answer. Further bytes are drained: old firmware
// adds one, and an error reply has one more.
Result<Ok> set(Dialogue& dialogue, bool text, std::string_view command) {
  const std::string_view letter = command.substr(0, 1);
  const auto reply = exchange(dialogue, text, command, 1, letter);
  if (!reply) return reply.error();
  if (const auto done = dialogue.drain(milliseconds(20), milliseconds(40)); !done) {
    return done.error();
  }
  return Ok{};
}

}  // namespace

CybergloveDevice::CybergloveDevice(const CybergloveSettings& settings, const Clock& clock,
                                   SampleSink& sink)
    : settings_(settings),
      text_(settings.dialogue == CybergloveSettings::Dialogue::kText),
      clock_(clock),
      sink_(sink) {}

Result<std::string> CybergloveDevice::open(ByteStream& stream) {
  Dialogue dialogue(stream, clock_);
  auto known = stopAndIdentify(dialogue);
  if (!known && known.error().code == Errc::kMalformed) known = stopAndIdentify(dialogue);
  if (!known) return known.error();
  if (const auto done = setUp(dialogue); !done) return done.error();
  parser_.expect({slots_.count, settings_.time_stamps, true, text_});
  if (const auto sent = dialogue.send(text_ ? "s\r" : "S"); !sent) return sent.error();
  last_record_ = clock_.now();
  last_stamp_ = 0;
  return fmt::format("CyberGlove, {} sensors", slots_.count);
}

Result<Ok> CybergloveDevice::stopAndIdentify(Dialogue& dialogue) {
  complaint_ = "";
  if (const auto sent = dialogue.send(kStop); !sent) return sent.error();
  if (const auto quiet = dialogue.drain(milliseconds(100), milliseconds(500)); !quiet) {
    return quiet.error();
  }
  return identify(dialogue);
}

Result<Ok> CybergloveDevice::identify(Dialogue& dialogue) {
  if (const auto sent = dialogue.send(text_ ? "?i\r" : "?i"); !sent) return sent.error();
  const auto info = dialogue.readUntil('\0', kLongestText, kReplyTime, "?i");
  if (!info) return info.error();
  if (info->find("CyberGlove") == std::string::npos) {
    return Error{Errc::kMalformed, fmt::format("not a CyberGlove: it identifies itself as \"{}\"",
                                               quoteBytes(*info))};
  }
  const auto state = ask(dialogue, text_, 'G', 1);
  if (!state) return state.error();
  if (!((*state)[0] & 2)) complaint_ = kUnplugged;
  const auto sensors = ask(dialogue, text_, 'S', 1);
  if (!sensors) return sensors.error();
  const auto mask = ask(dialogue, text_, 'K', 3);
  if (!mask) return mask.error();
  mask_ = decodeMask(mask->data());
  slots_ = slotsOf(mask_);
  const auto count = static_cast<std::uint8_t>((*sensors)[0]);
  if (count != slots_.count || count == 0) {
    return Error{
        Errc::kMalformed,
        fmt::format("the glove reports {} sensors, and its sensor mask has {} (0x{:06X}); the "
                    "two must be equal and not 0{}{}",
                    count, slots_.count, mask_, *complaint_ ? ": " : "", complaint_)};
  }
  return Ok{};
}

Result<Ok> CybergloveDevice::setUp(Dialogue& dialogue) {
  const std::string commands[] = {
      "M" + encodeMask(mask_),
      {'N', static_cast<char>(slots_.count)},
      {'U', '\1'},
      {'D', settings_.time_stamps ? '\1' : '\0'},
      {'F', settings_.filter ? '\1' : '\0'},
      {'J', settings_.light == CybergloveSettings::Light::kSwitch ? '\1' : '\0'},
      encodeRate(settings_.rate_hz),
  };
  for (const std::string& command : commands) {
    if (auto done = set(dialogue, text_, command); !done) return done;
  }
  if (settings_.light == CybergloveSettings::Light::kSwitch) return Ok{};
  const std::string light{'L', settings_.light == CybergloveSettings::Light::kOn ? '\1' : '\0'};
  return set(dialogue, text_, light);
}

Result<Ok> CybergloveDevice::poll(ByteStream& stream) {
  std::array<std::byte, 256> buffer;  // NOLINT: filled by read
  const auto got = stream.read(buffer, kPollTime);
  if (!got && got.error().code != Errc::kTimeout) return got.error();
  const Timestamp now = clock_.now();
  for (std::size_t i = 0; got && i < *got; ++i) {
    if (!parser_.inside()) packet_start_ = now;
    if (const auto packet = parser_.feed(buffer[i])) handle(*packet, packet_start_);
  }
  const Duration silence = now - last_record_;
  if (silence < std::max(kLongestSilence, fromSeconds(5 / settings_.rate_hz))) return Ok{};
  return Error{Errc::kTimeout, fmt::format("no record for {:.1f} s{}{}", toSeconds(silence),
                                           *complaint_ ? ": " : "", complaint_)};
}

void CybergloveDevice::handle(const Packet& packet, Timestamp first_byte) noexcept {
  if (const auto* refusal = std::get_if<Refusal>(&packet)) {
    if (refusal->code == 'g') complaint_ = kUnplugged;
    if (refusal->code == 's') complaint_ = kTooFast;
    return;
  }
  const Record& record = *std::get_if<Record>(&packet);
  const bool plugged = (record.status & Record::kPlugged) && !record.unplugged;
  complaint_ = !plugged ? kUnplugged : record.too_fast ? kTooFast : "";
  last_record_ = clock_.now();
  calibrate(record, slots_, settings_, sample_);
  sample_.received_ns = toNanoseconds(first_byte);
  sample_.counter += 1 + lostBefore(record);
  ++samples_;
  sink_.publish(sample_);
}

// Returns the number of records that were lost before this one, according to the unit's time
// stamps. Jitter of less than half a period is ignored.
std::uint32_t CybergloveDevice::lostBefore(const Record& record) noexcept {
  if (!settings_.time_stamps) return 0;
  const std::uint32_t ticks = record.timestamp - last_stamp_;
  const bool first = std::exchange(last_stamp_, record.timestamp) == 0;
  const double periods = ticks / kStampClock * settings_.rate_hz;
  if (first || periods < 1.5 || periods > kMostLost) return 0;
  return static_cast<std::uint32_t>(std::lround(periods)) - 1;
}

DeviceCounters CybergloveDevice::counters() const noexcept {
  return {samples_, parser_.badBytes(), parser_.badPackets()};
}

std::unique_ptr<Device> makeDevice(const CybergloveSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<CybergloveDevice>(settings, clock, sink);
}

}  // namespace merlin::cyberglove
