// Driver of buttons and analog channels on a VRPN server (a button box, a joystick, the buttons of
// a wand), which serve as a ball. Its port is tcp://HOST:3883.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "daemon/base/clock.h"
#include "drivers/port/device.h"
#include "drivers/port/held_ball.h"
#include "drivers/port/sample_sink.h"
#include "drivers/vrpn/client.h"
#include "drivers/vrpn/pad_input.h"
#include "drivers/vrpn/pad_settings.h"

namespace merlin::vrpn {

// open() takes at most 4 s; it ends when the server has described the device. Errors: those of
// Client::open(). A device at rest is silent, so silence is no fault while the server answers.
// complaint() reports a server that has neither buttons nor analogs, or no longer has the device.
// Publishes one sample for each message, and repeats a push that is held every 50 ms.
class VrpnPad final : public Device, private Listener {
 public:
  VrpnPad(const VrpnPadSettings& settings, const Clock& clock, SampleSink& sink);

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override {
    return {ball_.samples(), 0, client_.badPackets()};
  }
  const char* complaint() const noexcept override { return complaint_; }

  // Returns the present state of the device's buttons and channels.
  const PadInput& input() const noexcept { return input_; }

 private:
  bool take(std::size_t type, std::string_view payload, Timestamp first_byte) noexcept override;
  bool takePayload(std::size_t type, std::string_view payload) noexcept;

  std::string name_;
  const Clock& clock_;
  Client client_;
  HeldBall ball_;
  PadInput input_;
  const char* complaint_ = "";
};

std::unique_ptr<Device> makeDevice(const VrpnPadSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::vrpn
