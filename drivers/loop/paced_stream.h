// PacedStream: limits the rate at which a line is read. Uses a ByteStream and a Clock only.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/token_bucket.h"
#include "drivers/port/byte_stream.h"

namespace merlin {

// The rate limit of a line, over all its connections: closing and opening the line again does not
// raise it. Thread-bound; allocates nothing after construction.
class ReadPace {
 public:
  // `bytes_s`: the limit [bytes/s]. A burst may have as many bytes as the limit allows in a quarter
  // of a second, but at least 4 KiB (a pty's buffer) and at most 64 KiB. `changed` is called when
  // above() changes. REQUIRES: bytes_s > 0.
  ReadPace(double bytes_s, std::function<void()> changed);

  // Returns whether the line sends more than the limit: true from the moment when bytes have to
  // wait, until half of a burst is available again.
  bool above() const noexcept { return above_; }
  // Returns the text for messages, such as "sends more than 15.4 kB/s, the limit at which it is
  // read".
  const std::string& sentence() const noexcept { return sentence_; }

  // Returns the number of bytes that may be read at `now`; updates above().
  std::size_t allowed(Timestamp now);
  // How long read() sleeps while no byte may be read, before it tries again. Bytes collect in the
  // meantime, and one call for several bytes costs less than one for each.
  static constexpr Duration kPause = std::chrono::milliseconds(10);
  // Subtracts bytes that were read from the allowance.
  void charge(std::size_t bytes, Timestamp now) noexcept;

 private:
  void setAbove(bool above);

  // burst_: greatest number of bytes of a burst. step_: number of bytes (the limit times kPause)
  // that must be available before a line that waits is read again; otherwise each byte would need
  // its own system call.
  double burst_, step_;
  bool waits_ = false;
  TokenBucket bucket_;
  std::function<void()> changed_;
  std::string sentence_;
  bool above_ = false;
};

// A ByteStream that reads another one within a ReadPace. It reads up to 1 KiB ahead, so that a
// dialogue that takes single bytes needs few system calls. Bytes that were read ahead are lost with
// the stream. Thread-bound, except interrupt().
class PacedStream final : public ByteStream {
 public:
  // `pace` and `clock` must outlive this.
  PacedStream(std::unique_ptr<ByteStream> inner, ReadPace& pace, Clock& clock);

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override;
  Result<std::size_t> write(std::span<const std::byte> bytes, Duration timeout) override;
  void interrupt() noexcept override;

 private:
  Result<Ok> fill(Duration timeout);

  std::unique_ptr<ByteStream> inner_;
  ReadPace& pace_;
  Clock& clock_;
  std::stop_source interrupted_;
  std::array<std::byte, 1024> ahead_;  // NOLINT(*-member-init): filled by read
  std::size_t next_ = 0, end_ = 0;     // range of ahead_ that read() has not returned yet
};

}  // namespace merlin
