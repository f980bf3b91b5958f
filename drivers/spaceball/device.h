// Driver of a Spaceball: resets it, awaits its banner, sets it up and streams; sets it up again
// whenever the ball resets by itself.
#pragma once

#include <memory>

#include "daemon/base/clock.h"
#include "drivers/port/device.h"
#include "drivers/port/sample_sink.h"
#include "drivers/spaceball/protocol.h"
#include "drivers/spaceball/settings.h"

namespace merlin::spaceball {

// open() takes up to 10 s: the ball is silent for about 2 s after a reset. A ball that works but
// does not react to the reset command is asked for its model instead. A ball at rest is silent;
// poll() fails with kTimeout if a ball that was silent for 2 s does not answer a ping within 1 s.
class SpaceballDevice final : public Device {
 public:
  SpaceballDevice(const SpaceballSettings& settings, const Clock& clock, SampleSink& sink);

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override;
  const char* complaint() const noexcept override { return complaint_; }

 private:
  Result<std::string> awaitBanner(ByteStream& stream);
  Result<Ok> setUp(ByteStream& stream);
  Result<Ok> keepAlive(ByteStream& stream);
  Result<Ok> handle(const Packet& packet, Timestamp first_byte, ByteStream& stream);
  void publish(Timestamp first_byte) noexcept;

  SpaceballSettings settings_;
  const Clock& clock_;
  SampleSink& sink_;
  Parser parser_;
  Model model_ = Model::k2003;
  BallSample sample_{};
  std::uint64_t samples_ = 0;
  Timestamp packet_start_{};
  Timestamp last_heard_{};
  bool pinged_ = false;
  bool fresh_ = true;       // nothing published since open()
  bool confirmed_ = false;  // the ball has confirmed that it was switched on
  const char* complaint_ = "";
  int set_ups_ = 0;  // repeated set-ups since the last confirmation
  Timestamp set_up_at_{};
};

std::unique_ptr<Device> makeDevice(const SpaceballSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::spaceball
