// A CyberGlove's dialogue: stop, identify, set up, stream.
#pragma once

#include <memory>
#include <string_view>

#include "daemon/base/clock.h"
#include "drivers/cyberglove/protocol.h"
#include "drivers/cyberglove/settings.h"
#include "drivers/port/device.h"
#include "drivers/port/dialogue.h"
#include "drivers/port/sample_sink.h"

namespace merlin::cyberglove {

// open() takes about 0.3 s, and 1 s where the interface unit streams on or is silent. poll() fails
// with kTimeout when no record came for 0.5 s, or for 5 periods of a rate below 10 Hz. A glove that
// is not plugged in is a complaint and no error, as long as its unit streams.
class CybergloveDevice final : public Device {
 public:
  CybergloveDevice(const CybergloveSettings& settings, const Clock& clock, SampleSink& sink);

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override;
  const char* complaint() const noexcept override { return complaint_; }

 private:
  Result<Ok> identify(Dialogue& dialogue);
  Result<Ok> setUp(Dialogue& dialogue);
  std::uint32_t lostBefore(const Record& record) noexcept;
  void handle(const Packet& packet, Timestamp first_byte) noexcept;

  CybergloveSettings settings_;
  bool text_;  // the ASCII dialogue is spoken
  const Clock& clock_;
  SampleSink& sink_;
  Parser parser_;
  std::uint32_t mask_ = 0;  // of the sensors that the glove has
  SlotList slots_;
  GloveSample sample_{};
  std::uint32_t last_stamp_ = 0;  // of the last record; 0 before the first
  std::uint64_t samples_ = 0;
  Timestamp packet_start_{};
  Timestamp last_record_{};
  const char* complaint_ = "";
};

std::unique_ptr<Device> makeDevice(const CybergloveSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::cyberglove
