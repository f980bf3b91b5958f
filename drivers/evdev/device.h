// Driver of an input device of the kernel that serves as the ball: a gamepad, a joystick, a space
// mouse without spacenavd, a presenter's clicker. Its port is evdev:/dev/input/by-id/...
#pragma once

#include <memory>
#include <string>

#include "daemon/base/clock.h"
#include "drivers/evdev/input_device.h"
#include "drivers/evdev/settings.h"
#include "drivers/port/device.h"
#include "drivers/port/evdev_reader.h"
#include "drivers/port/held_ball.h"

namespace merlin::evdev {

// open() reads the device's description, which takes at most 1 s. A device at rest is silent, so
// silence is no fault: the connection ends when the device is unplugged.
class EvdevDevice final : public Device {
 public:
  EvdevDevice(const EvdevSettings& settings, const Clock& clock, SampleSink& sink)
      : settings_(settings), clock_(clock), sink_(sink), reader_(clock), ball_(sink) {}

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override;
  const char* complaint() const noexcept override { return complaint_.c_str(); }

  // Returns the device's axes and keys, and which of them are used. Valid after open().
  const InputDevice& input() const noexcept { return input_; }

 private:
  void report(Timestamp first_byte) noexcept;

  EvdevSettings settings_;
  const Clock& clock_;
  SampleSink& sink_;
  EvdevReader reader_;
  HeldBall ball_;
  InputDevice input_;
  std::string complaint_;
};

std::unique_ptr<Device> makeDevice(const EvdevSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::evdev
