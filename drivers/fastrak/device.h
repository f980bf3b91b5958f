// Driver of a Fastrak: stops its stream, reads its status and stations, sets it up and streams.
#pragma once

#include <memory>

#include "daemon/base/clock.h"
#include "drivers/fastrak/protocol.h"
#include "drivers/fastrak/settings.h"
#include "drivers/port/device.h"
#include "drivers/port/dialogue.h"
#include "drivers/port/sample_sink.h"

namespace merlin::fastrak {

// open() takes about 0.5 s, at most 2 s. After every fourth failure of open() in a row the next one
// reinitialises the unit first and takes up to 12 s, because the unit ignores its input for up to
// 10 s while it starts. poll() fails with kTimeout after 0.5 s without a record. Publishes one
// sample per record; each station has its own counter.
class FastrakDevice final : public Device {
 public:
  FastrakDevice(const FastrakSettings& settings, const Clock& clock, SampleSink& sink);

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override;
  const char* complaint() const noexcept override { return complaint_; }

 private:
  Result<std::string> talk(Dialogue& dialogue);
  Result<Status> identify(Dialogue& dialogue);
  Result<Stations> askStations(Dialogue& dialogue);
  Result<Ok> setUp(Dialogue& dialogue, const Stations& stations);
  std::string stationSetUp(std::size_t index) const;
  void publish(const Record& record) noexcept;
  void noteErrors() noexcept;

  FastrakSettings settings_;
  const Clock& clock_;
  SampleSink& sink_;
  Layout layout_;
  Parser parser_;
  std::array<TrackerSample, kStations> sample_{};  // newest sample of each station
  std::uint64_t samples_ = 0;
  Timestamp last_record_{};
  int failures_ = 0;  // consecutive calls of open() in which the unit did not answer correctly
  char complaint_[80] = "";
};

std::unique_ptr<Device> makeDevice(const FastrakSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::fastrak
