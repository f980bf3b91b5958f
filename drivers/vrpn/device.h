// Driver of a tracker on a VRPN server, as a client of that server. Its port is tcp://HOST:3883.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/base/clock.h"
#include "drivers/port/device.h"
#include "drivers/port/sample_sink.h"
#include "drivers/vrpn/client.h"
#include "drivers/vrpn/settings.h"

namespace merlin::vrpn {

// open() takes at most 4 s; it ends with the first pose. Errors: those of Client::open(); among
// them kTimeout if the device has sent no pose. If the server answers but sends no pose, poll()
// does not fail, because the cameras may have lost the target; complaint() reports it after 2 s,
// and at once if the server no longer has the device. Publishes one sample per pose of a sensor
// that is a station; each station has its own counter.
class VrpnDevice final : public Device, private Listener {
 public:
  VrpnDevice(const VrpnSettings& settings, const Clock& clock, SampleSink& sink);

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override { return {samples_, 0, client_.badPackets()}; }
  const char* complaint() const noexcept override { return complaint_; }

 private:
  bool take(std::size_t type, std::string_view payload, Timestamp first_byte) noexcept override;
  bool publish(const VrpnPose& pose, Timestamp first_byte) noexcept;

  VrpnSettings settings_;
  const Clock& clock_;
  SampleSink& sink_;
  Client client_;
  std::array<TrackerSample, kStations> sample_{};  // newest sample of each station
  std::uint64_t samples_ = 0;
  Timestamp posed_{};
  const char* silence_ = "";  // why no sample was published since the last one
  const char* complaint_ = "";
};

std::unique_ptr<Device> makeDevice(const VrpnSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::vrpn
