// Driver of a CyberGlove: stops its stream, identifies it, sets it up and streams.
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

// open() takes about 0.3 s, or 1 s if the interface unit does not stop streaming or does not
// answer. If the answer is not a CyberGlove's, the driver stops the stream and asks once more
// before it fails, which takes as long again: a glove that returns after a silence first sends the
// rest of its stream and the answers to earlier commands. poll() fails with kTimeout after 0.5 s
// without a record, or 5 periods if the rate is below 10 Hz. While the interface unit streams,
// complaint() reports an unplugged glove; it is not an error.
class CybergloveDevice final : public Device {
 public:
  CybergloveDevice(const CybergloveSettings& settings, const Clock& clock, SampleSink& sink);

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override;
  const char* complaint() const noexcept override { return complaint_; }

 private:
  Result<Ok> stopAndIdentify(Dialogue& dialogue);
  Result<Ok> identify(Dialogue& dialogue);
  Result<Ok> setUp(Dialogue& dialogue);
  std::uint32_t lostBefore(const Record& record) noexcept;
  void handle(const Packet& packet, Timestamp first_byte) noexcept;

  CybergloveSettings settings_;
  bool text_;  // uses the ASCII dialogue
  const Clock& clock_;
  SampleSink& sink_;
  Parser parser_;
  std::uint32_t mask_ = 0;  // slots for which the glove has a sensor
  SlotList slots_;
  GloveSample sample_{};
  std::uint32_t last_stamp_ = 0;  // time stamp of the last record; 0 before the first
  std::uint64_t samples_ = 0;
  Timestamp packet_start_{};
  Timestamp last_record_{};
  const char* complaint_ = "";
};

std::unique_ptr<Device> makeDevice(const CybergloveSettings& settings, const Clock& clock,
                                   SampleSink& sink);

}  // namespace merlin::cyberglove
