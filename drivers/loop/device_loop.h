// DeviceLoop: opens one device, polls it, and opens it again whenever the device or its line fails.
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
  std::string port;  // as in the configuration, for the health record
  int baud = 0;      // named in the hint about malformed bytes; 0: no hint
  // Maximum rate at which the line is read; 0: no limit. Further bytes wait in the system's
  // buffers; when these are full, the sender blocks or bytes are lost.
  double max_bytes_s = 0;
  // Called on the loop's thread when the line begins (`above` is true) or ceases (false) to send
  // more than max_bytes_s, so that the caller can lower the thread's priority in between.
  std::function<void(bool above)> on_pace = [](bool) {};
  // Delay before the next attempt to open the device. It is doubled after each failure, up to
  // longest_retry, and reset after a connection that streamed.
  Duration first_retry = std::chrono::milliseconds(100);
  // Short, because an attempt costs little, and a device that is connected again should stream
  // within a second, including its set-up.
  Duration longest_retry = std::chrono::milliseconds(250);
};

// Uses interfaces and a Clock only. Owns no thread: run() is the body of a thread. Thread-bound,
// except that any thread may request the stop.
class DeviceLoop {
 public:
  DeviceLoop(DeviceLoopSettings settings, StreamOpener open_stream, std::unique_ptr<Device> device,
             HealthSink& health, Clock& clock);

  // Opens and polls the device until `stop`, with a delay after each failure; returns within about
  // 50 ms after the stop request. Shares nothing with other devices, so it cannot block them.
  // `alive` is called before each attempt. It is not called while a port is open: then the stream
  // that the opener returns has to report progress.
  void run(
      const std::stop_token& stop, const std::function<void()>& alive = [] {});

 private:
  // Serves one connection, from opening the port to losing it; returns why the connection ended.
  Error serve(const std::stop_token& stop);
  Error pollUntilLost(ByteStream& stream, const std::stop_token& stop);

  std::unique_ptr<ByteStream> paced(std::unique_ptr<ByteStream> stream);
  void paceChanged();
  // Returns the text for the health record: a warning if the line sends too much, followed by
  // `reason`.
  std::string withPace(const std::string& reason);
  std::string hintFor(const Error& end) const;
  void enter(HealthState state, std::string_view reason) noexcept;
  void report() noexcept;  // publishes health_ with counters and rate, at most every 100 ms
  void measureRate(Timestamp now) noexcept;

  DeviceLoopSettings settings_;
  StreamOpener open_stream_;
  std::unique_ptr<Device> device_;
  HealthSink& sink_;
  Clock& clock_;
  std::optional<ReadPace> pace_;  // empty: the line has no rate limit
  DeviceHealth health_{};
  bool opened_ = false;    // the port was opened for this connection
  bool streamed_ = false;  // a sample arrived over this connection
  Timestamp rate_since_{};
  std::uint64_t rate_samples_ = 0;
  Timestamp reported_{};
};

}  // namespace merlin
