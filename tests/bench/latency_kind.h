// The kinds of devices in ./dev bench latency: their records, and the channels of their samples.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "daemon/shm/layout.h"
#include "drivers/port/device.h"
#include "drivers/port/sample_sink.h"

namespace merlin::bench {

struct Kind {
  const char* name;  // for example "glove"
  // The emulator that answers the driver's dialogue, for example "cyberglove". If it is null,
  // greeting() answers.
  const char* emulator;
  SampleKind kind;
  std::unique_ptr<Device> (*make)(const Clock&, SampleSink&);
  // Returns the n-th record as the device sends it. All records of a kind have the same length.
  std::string (*record)(std::uint32_t n);
  // Returns the bytes that a device without an emulator sends when its line is opened.
  std::string (*greeting)() = nullptr;
};

// A CyberGlove, a Fastrak with one station, a Spaceball.
extern const Kind kGloveKind, kTrackerKind, kBallKind;
// Present-day devices, in the form in which their ports deliver data: a gamepad and a touch frame
// as kernel input devices, a tracker and the analogs of a VRPN server, a tracker over OSC, a touch
// surface over TUIO.
extern const Kind kGamepadKind, kTouchKind, kVrpnTrackerKind, kVrpnPadKind, kOscKind, kTuioKind;

// Calls `use` with the channel of the first device of this kind, which for a tracker is the channel
// of its first station. `segment`: a shm::DevicesSegment, const or not.
template <typename Segment, typename Use>
auto withChannel(Segment& segment, const Kind& kind, Use use) {
  if (kind.kind == SampleKind::kGlove) return use(segment.glove[0].samples);
  if (kind.kind == SampleKind::kTracker) return use(segment.tracker[0].stations[0]);
  if (kind.kind == SampleKind::kTouch) return use(segment.touch[0]);
  return use(segment.ball[0]);
}

}  // namespace merlin::bench
