// Poses: extracts the tracker's samples from OSC messages and publishes them. Otherwise pure.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "drivers/osc/settings.h"
#include "drivers/port/osc_packet.h"
#include "drivers/port/sample_sink.h"

namespace merlin::osc {

class Poses final : public OscSink {
 public:
  // REQUIRES: validate() finds no fault in the settings.
  Poses(const OscSettings& settings, SampleSink& sink);

  // Sets the arrival time of the messages that follow.
  void begin(Timestamp received) noexcept { received_ = received; }
  // Publishes a sample if the message is the pose of a station. An implausible pose
  // (drivers/port/plausible.h) is dropped and counted. Allocates only while addresses are
  // collected.
  void take(const OscMessage& message) noexcept override;

  // Starts or stops the collection of the addresses of messages that are not poses, at most
  // kMostOthers.
  void collectOthers(bool collect);
  const std::vector<std::string>& others() const noexcept { return others_; }
  static constexpr std::size_t kMostOthers = 6;

  std::uint64_t samples() const noexcept { return samples_; }
  std::uint64_t badPoses() const noexcept { return bad_poses_; }
  // Returns why the newest message gave no sample; empty if it gave one, or if no message has
  // arrived.
  const char* silence() const noexcept { return silence_; }
  void forgetSilence() noexcept { silence_ = ""; }
  // Returns the address at which the poses of the first used station are expected, for messages to
  // a person.
  std::string expected() const;

 private:
  struct Station {
    bool used = false;
    std::string name, address;  // `address`: of its messages
  };

  // Returns the index of the message's station, or kStations if it has none; `names` is set to the
  // number of arguments that name the station.
  std::size_t stationOf(const OscMessage& message, std::size_t& names) const noexcept;
  void other(const OscMessage& message) noexcept;
  void bad(const char* why) noexcept;

  OscSettings settings_;
  SampleSink& sink_;
  std::array<Station, kStations> stations_;
  bool named_by_address_ = false;
  std::array<TrackerSample, kStations> sample_{};  // newest sample of each station
  Timestamp received_{};
  std::uint64_t samples_ = 0, bad_poses_ = 0;
  const char* silence_ = "";
  bool collects_ = false;
  std::vector<std::string> others_;
};

}  // namespace merlin::osc
