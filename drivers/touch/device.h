// Driver of a touch frame, a touch screen or a mouse that the kernel reads. Its port is
// evdev:/dev/input/by-id/...
#pragma once

#include <memory>
#include <string>

#include "daemon/base/clock.h"
#include "drivers/port/device.h"
#include "drivers/port/evdev_reader.h"
#include "drivers/port/touch_frames.h"
#include "drivers/touch/settings.h"
#include "drivers/touch/surface.h"

namespace merlin::touch {

// open() reads the device's description, which takes at most 1 s; it also fails with kMalformed if
// the device is neither a touch surface nor a mouse. poll() publishes a sample for each report of
// the device in which a finger comes, moves or goes. A device that nobody touches is silent, so
// silence is no fault: the connection ends when the device is unplugged. The next open() removes
// the fingers of the previous connection.
class TouchDevice final : public Device {
 public:
  TouchDevice(const TouchSettings& settings, const Clock& clock, SampleSink& sink)
      : settings_(settings),
        clock_(clock),
        sink_(sink),
        reader_(clock),
        frames_(sink, settings.orientation) {}

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override;
  const char* complaint() const noexcept override { return ""; }

 private:
  void publish(Timestamp at) noexcept;

  TouchSettings settings_;
  const Clock& clock_;
  SampleSink& sink_;
  EvdevReader reader_;
  TouchFrames frames_;
  Surface surface_;
};

std::unique_ptr<Device> makeDevice(const TouchSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::touch
