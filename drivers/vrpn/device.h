// Driver of a tracker that a VRPN server serves: a client of the server, which is the port
// tcp://HOST:3883.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/clock.h"
#include "drivers/port/device.h"
#include "drivers/port/sample_sink.h"
#include "drivers/vrpn/protocol.h"
#include "drivers/vrpn/settings.h"

namespace merlin::vrpn {

// open() takes at most 4 s; it ends with the first pose. Errors also: kMalformed (no server of VRPN
// 7, or it has no device of this name), kTimeout (the device has sent no pose). poll() pings the
// server each second and fails with kTimeout after 3 s without a byte. A server that answers and
// sends no pose is no fault: cameras may have lost the target; complaint() says so after 2 s.
// Publishes one sample per pose of a sensor that is a station; each station has its own counter.
class VrpnDevice final : public Device {
 public:
  VrpnDevice(VrpnSettings settings, const Clock& clock, SampleSink& sink);

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override { return {samples_, 0, bad_packets_}; }
  const char* complaint() const noexcept override { return complaint_; }

 private:
  void restart() noexcept;
  std::string introduction();
  Result<Ok> awaitPose(ByteStream& stream);
  Error noPose() const;
  Result<Ok> receive(ByteStream& stream, Duration timeout);
  Result<Ok> ping(ByteStream& stream);
  void handle(const Message& message);
  void describeSender(const Message& message);
  void describeType(const Message& message) noexcept;
  void take(const VrpnPose& pose) noexcept;

  VrpnSettings settings_;
  const Clock& clock_;
  SampleSink& sink_;
  Parser parser_;
  // The server's numbers, as it described them last.
  std::optional<std::int32_t> device_, pose_type_;
  std::vector<std::string> others_;  // devices of other names that were described during open()
  bool opening_ = false;
  std::array<TrackerSample, kStations> sample_{};  // the newest of each station
  std::uint64_t samples_ = 0, bad_packets_ = 0;
  std::uint32_t sequence_ = 0;  // of the messages to the server
  std::string ping_;
  Timestamp message_start_{}, heard_{}, pinged_{}, posed_{};
  const char* silence_ = "";  // why no sample was published since the last one
  const char* complaint_ = "";
};

std::unique_ptr<Device> makeDevice(const VrpnSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::vrpn
