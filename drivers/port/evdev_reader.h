// EvdevReader: reads the line protocol of evdev_line.h for a driver: the description of an input
// device when it is opened, then its reports.
#pragma once

#include <array>
#include <span>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "drivers/port/byte_stream.h"
#include "drivers/port/evdev_line.h"
#include "drivers/port/sample_sink.h"

namespace merlin {

// Thread-bound to the device's thread. Allocates nothing.
class EvdevReader {
 public:
  explicit EvdevReader(const Clock& clock) : clock_(clock) {}

  // Reads a new connection's description; calls describe(record) for each of its records. Errors:
  // kTimeout (no complete description within 1 s), and those of the stream.
  template <typename Describe>
  Result<Ok> open(ByteStream& stream, const Describe& describe) {
    parser_.reset();
    in_report_ = false;
    keys_.reset();
    const Timestamp until = clock_.now() + kDescriptionTime;
    for (;;) {
      std::byte byte{};  // one by one: bytes after the description are left for poll()
      const Duration left = until - clock_.now();
      if (left <= Duration::zero())
        return Error{Errc::kTimeout, "no complete description of an input device within 1 s"};
      const auto got = stream.read(std::span(&byte, 1), left);
      if (!got && got.error().code == Errc::kTimeout) continue;
      if (!got) return got.error();
      const auto record = parser_.feed(byte);
      if (!record) continue;
      describe(*record);
      if (record->kind == EvdevRecord::kKey && record->code < keys_.size()) keys_.set(record->code);
      if (record->kind == EvdevRecord::kReady) return Ok{};
    }
  }

  // Reads what arrives within `wait`, once: calls take(record) for each record, and report(at) at
  // the end of each report, whose first byte arrived at `at`. Returns the time at which the bytes
  // arrived. A time-out is not an error. Errors: all others of the stream.
  template <typename Take, typename Report>
  Result<Timestamp> poll(ByteStream& stream, Duration wait, const Take& take,
                         const Report& report) {
    std::array<std::byte, kBuffer> buffer;  // NOLINT(*-member-init): filled by read
    const auto got = stream.read(buffer, wait);
    const Timestamp now = clock_.now();
    if (!got && got.error().code != Errc::kTimeout) return got.error();
    for (std::size_t i = 0; got && i < *got; ++i) {
      if (!in_report_) report_start_ = now;
      in_report_ = true;
      const auto record = parser_.feed(buffer[i]);
      if (!record) continue;
      take(*record);
      if (record->kind != EvdevRecord::kReport) continue;
      in_report_ = false;
      report(report_start_);
    }
    return now;
  }

  // Keys of the device that was opened last.
  const DeviceKeys& keys() const noexcept { return keys_; }
  std::uint64_t badBytes() const noexcept { return parser_.badBytes(); }
  std::uint64_t badPackets() const noexcept { return parser_.badPackets(); }

 private:
  static constexpr Duration kDescriptionTime = std::chrono::milliseconds(1000);
  static constexpr std::size_t kBuffer = 16 * 24;  // sixteen records

  const Clock& clock_;
  EvdevParser parser_;
  DeviceKeys keys_;
  bool in_report_ = false;
  Timestamp report_start_{};
};

}  // namespace merlin
