// The kinds of devices in ./dev bench latency: what each sends, and where its samples are.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "daemon/shm/layout.h"
#include "drivers/port/device.h"
#include "drivers/port/sample_sink.h"

namespace merlin::bench {

struct Kind {
  const char* name;      // "glove"
  const char* emulator;  // that answers the driver's dialogue: "cyberglove"; null: greeting() does
  SampleKind kind;
  std::unique_ptr<Device> (*make)(const Clock&, SampleSink&);
  // The n-th record as the device sends it. All records of a kind have the same length.
  std::string (*record)(std::uint32_t n);
  // What a device without an emulator says when its line is opened, whatever it is asked.
  std::string (*greeting)() = nullptr;
};

// A CyberGlove, a Fastrak with one station, a Spaceball.
extern const Kind kGloveKind, kTrackerKind, kBallKind;
// A gamepad and a touch frame of the kernel, a tracker and the analogs of a VRPN server, a tracker
// by OSC, a touch surface by TUIO: as their ports carry what they say.
extern const Kind kGamepadKind, kTouchKind, kVrpnTrackerKind, kVrpnPadKind, kOscKind, kTuioKind;

// Calls `use` with the channel of the first device of this kind; of a tracker its first station's.
// `segment`: a shm::DevicesSegment, const or not.
template <typename Segment, typename Use>
auto withChannel(Segment& segment, const Kind& kind, Use use) {
  if (kind.kind == SampleKind::kGlove) return use(segment.glove[0].samples);
  if (kind.kind == SampleKind::kTracker) return use(segment.tracker[0].stations[0]);
  if (kind.kind == SampleKind::kTouch) return use(segment.touch[0]);
  return use(segment.ball[0]);
}

}  // namespace merlin::bench
