// DeviceLoop: keeps one device alive and publishing, whatever happens to its line.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "daemon/base/clock.h"
#include "drivers/loop/paced_stream.h"
#include "drivers/port/byte_stream.h"
#include "drivers/port/device.h"
#include "drivers/port/sample_sink.h"

namespace merlin {

struct DeviceLoopSettings {
  std::string port;  // as a person wrote it, for the health
  int baud = 0;      // of the line, for the hint where what comes makes no sense; 0: no hint
  // Maximum rate at which the line is read; 0: as fast as it sends. Further bytes wait in the
  // system's buffers, which block the sender or drop what it sends.
  double max_bytes_s = 0;
  // Told, on the loop's thread, when the line begins or ceases to send more than that; no time of
  // others is for such a line.
  std::function<void(bool above)> on_pace = [](bool) {};
  Duration first_retry = std::chrono::milliseconds(100);  // doubled after each failure,
  // Up to this; reset by success. Short, since an attempt costs next to nothing, and a device that
  // is back should be heard within a second, its dialogue included.
  Duration longest_retry = std::chrono::milliseconds(250);
};

// Over ports and a Clock only; owns no thread: run() is the body of one. Thread-bound but for the
// stop token, which may be triggered from anywhere.
class DeviceLoop {
 public:
  DeviceLoop(DeviceLoopSettings settings, StreamOpener open_stream, std::unique_ptr<Device> device,
             HealthSink& health, Clock& clock);

  // Opens, talks, polls, backs off and starts again, until `stop`; returns within about 50 ms of
  // it. Blocks no other device: it shares nothing with them.
  // `alive` is called several times a second while it waits to try again; while a port is open, its
  // stream sees the progress.
  void run(
      const std::stop_token& stop, const std::function<void()>& alive = [] {});

 private:
  // One connection, from opening the port to losing it; returns why it ended.
  Error serve(const std::stop_token& stop);
  Error pollUntilLost(ByteStream& stream, const std::stop_token& stop);

  std::unique_ptr<ByteStream> paced(std::unique_ptr<ByteStream> stream);
  void paceChanged();
  // Text of the health: of the line if it sends too much, then `reason`.
  std::string withPace(const std::string& reason);
  std::string hintFor(const Error& end) const;
  void enter(HealthState state, std::string_view reason) noexcept;
  void report() noexcept;  // publishes health_, with counters and rate, at most every 100 ms
  void measureRate(Timestamp now) noexcept;

  DeviceLoopSettings settings_;
  StreamOpener open_stream_;
  std::unique_ptr<Device> device_;
  HealthSink& sink_;
  Clock& clock_;
  std::optional<ReadPace> pace_;  // where the line has one
  DeviceHealth health_{};
  bool opened_ = false;    // this connection came as far as an open port
  bool streamed_ = false;  // and as far as a sample
  Timestamp rate_since_{};
  std::uint64_t rate_samples_ = 0;
  Timestamp reported_{};
};

}  // namespace merlin
