#include "tests/bench/latency_kind.h"

#include "drivers/cyberglove/device.h"
#include "drivers/cyberglove/protocol.h"
#include "drivers/fastrak/device.h"
#include "drivers/fastrak/protocol.h"
#include "drivers/spaceball/device.h"
#include "drivers/spaceball/protocol.h"

namespace merlin::bench {
namespace {

std::string gloveRecord(std::uint32_t n) {
  cyberglove::Record r;
  for (std::size_t i = 0; i < 22; ++i) r.values[i] = static_cast<std::uint8_t>(1 + (n + i) % 255);
  return cyberglove::encode(r, {.values = 22, .timestamp = false, .status = true});
}

std::string trackerRecord(std::uint32_t n) {
  fastrak::Record r;
  r.position = {60, 5, static_cast<float>(n % 100) / 10};
  return fastrak::encode(r, fastrak::kDriverList, {});
}

// Returns a record of the ball whose counts have no bytes that need an escape.
std::string ballRecord(std::uint32_t n) {
  spaceball::Displacement d;
  d.axes = {static_cast<std::int16_t>(0x0420 + n % 16), 0x0121, 0x0122, 0x0123, 0x0124, 0x0125};
  d.period = 0x0050;
  return spaceball::encode(d);
}

}  // namespace

const Kind kGloveKind = {
    "glove", "cyberglove", SampleKind::kGlove,
    [](const Clock& clock, SampleSink& sink) { return cyberglove::makeDevice({}, clock, sink); },
    &gloveRecord};
const Kind kTrackerKind = {
    "tracker", "fastrak", SampleKind::kTracker,
    [](const Clock& clock, SampleSink& sink) { return fastrak::makeDevice({}, clock, sink); },
    &trackerRecord};
const Kind kBallKind = {
    "ball", "spaceball", SampleKind::kBall,
    [](const Clock& clock, SampleSink& sink) { return spaceball::makeDevice({}, clock, sink); },
    &ballRecord};

}  // namespace merlin::bench
