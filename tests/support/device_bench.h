// DeviceBench: everything that a Device under test needs: an emulator (chosen by name) on a
// FakeStream, a FakeClock and a sample sink.
#pragma once

#include <cassert>
#include <memory>
#include <string>

#include "drivers/emulate/emulator.h"
#include "drivers/port/device.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/recording_sink.h"

namespace merlin::test {

struct DeviceBench {
  DeviceBench(const char* device, const emulate::EmulatorSettings& settings,
              const char* script_name)
      : script(*emulate::findMotionScript(script_name)), start(clock.now()) {
    const emulate::EmulatorEntry* entry = emulate::findEmulator(device);
    assert(entry);
    emulator = entry->make(settings, script, start);
    stream.plug(emulator.get());
  }

  // Polls until `time` has passed or the device fails.
  Result<Ok> pollFor(Device& device, Duration time) {
    for (const Timestamp end = clock.now() + time; clock.now() < end;) {
      if (const auto polled = device.poll(stream); !polled) return polled;
    }
    return Ok{};
  }

  // Returns how long the device tolerates silence before it fails; `most` if it does not fail
  // within `most`.
  Duration timeToFail(Device& device, Duration most) {
    const Timestamp from = clock.now();
    return pollFor(device, most) ? most : clock.now() - from;
  }

  FakeClock clock;
  emulate::MotionScript script;
  Timestamp start;
  RecordingSink sink;
  std::unique_ptr<emulate::Emulator> emulator;
  FakeStream stream{clock, nullptr};
};

}  // namespace merlin::test
