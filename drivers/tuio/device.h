// Driver of a touch surface whose tracker speaks TUIO 1.1. Its port is udp:3333, to which trackers
// send.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/clock.h"
#include "drivers/port/datagram_line.h"
#include "drivers/port/device.h"
#include "drivers/port/osc_packet.h"
#include "drivers/port/touch_frames.h"
#include "drivers/tuio/settings.h"
#include "drivers/tuio/sources.h"

namespace merlin::tuio {

// open() does not wait for data: a tracker need not send while nobody touches its surface, so
// silence is no fault. poll() publishes a sample for each datagram that changes which fingers
// touch, or where. A source that is silent for 2 s counts as having no fingers on it; if all
// sources are silent, complaint() says so.
class TuioDevice final : public Device {
 public:
  TuioDevice(const TuioSettings& settings, const Clock& clock, SampleSink& sink);

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override;
  const char* complaint() const noexcept override { return complaint_; }

 private:
  void take(const Datagram& datagram, Timestamp first_byte) noexcept;
  void publish(Timestamp at) noexcept;

  const Clock& clock_;
  TouchFrames frames_;
  DatagramParser parser_;
  OscReader osc_;
  Sources sources_;
  Timestamp datagram_start_{};
  std::uint64_t bad_datagrams_ = 0;  // number of datagrams that are not OSC
  bool heard_ = false;               // a complete frame came since open()
  const char* fault_ = "";           // of the newest datagram, if it was not a frame
  Timestamp faulted_{};              // arrival of that datagram
  const char* complaint_ = "";
};

std::unique_ptr<Device> makeDevice(const TuioSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::tuio
