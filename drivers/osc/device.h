// Driver of a tracker whose poses arrive as OSC messages. Its port is udp:PORT, the port to which
// the poses are sent.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/clock.h"
#include "drivers/osc/poses.h"
#include "drivers/osc/settings.h"
#include "drivers/port/datagram_line.h"
#include "drivers/port/device.h"
#include "drivers/port/osc_packet.h"

namespace merlin::osc {

// open() takes at most 2 s; it ends with the first pose. Errors also: kTimeout (nothing arrives),
// kMalformed (what arrives is not a pose of a station). poll() fails with kTimeout after 3 s
// without a datagram. If only other messages arrive, poll() does not fail, because the cameras may
// have lost the target; complaint() reports it after 2 s. Publishes one sample per pose; each
// station has its own counter.
class OscDevice final : public Device {
 public:
  OscDevice(const OscSettings& settings, const Clock& clock, SampleSink& sink)
      : clock_(clock), poses_(settings, sink) {}

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override;
  const char* complaint() const noexcept override { return complaint_; }

 private:
  Result<Ok> receive(ByteStream& stream, Duration timeout);
  void take(const Datagram& datagram) noexcept;
  Error noPose() const;

  const Clock& clock_;
  Poses poses_;
  DatagramParser parser_;
  OscReader osc_;
  Timestamp datagram_start_{}, heard_{}, posed_{};
  std::uint64_t datagrams_ = 0;  // number since open()
  std::uint64_t bad_datagrams_ = 0;
  bool no_osc_ = false;  // the newest datagram was not OSC
  const char* complaint_ = "";
};

std::unique_ptr<Device> makeDevice(const OscSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::osc
