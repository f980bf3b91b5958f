// Driver of a space mouse that spacenavd reads: a client of spacenavd's socket, which is the port
// unix:/run/spnav.sock.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/clock.h"
#include "drivers/port/device.h"
#include "drivers/port/held_ball.h"
#include "drivers/spacenav/protocol.h"
#include "drivers/spacenav/settings.h"

namespace merlin::spacenav {

// open() takes at most 1.3 s; it also accepts a spacenavd with version 0 of the protocol, which
// gives no device name. A space mouse at rest is silent, so silence is no fault: poll() fails only
// when spacenavd ends.
class SpacenavDevice final : public Device {
 public:
  SpacenavDevice(const SpacenavSettings& settings, const Clock& clock, SampleSink& sink)
      : settings_(settings), clock_(clock), ball_(sink) {}

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override;
  const char* complaint() const noexcept override;

 private:
  Result<Ok> greet(ByteStream& stream);
  Result<std::string> askName(ByteStream& stream);
  void handle(const Frame& frame, Timestamp first_byte) noexcept;
  void move(const Frame& frame) noexcept;

  SpacenavSettings settings_;
  const Clock& clock_;
  HeldBall ball_;
  Parser parser_;
  Timestamp frame_start_{};
  bool has_names_ = false;  // spacenavd speaks version 1
  bool mouse_lost_ = false;
};

std::unique_ptr<Device> makeDevice(const SpacenavSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::spacenav
