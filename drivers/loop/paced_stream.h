// PacedStream: a line that is read no faster than so many bytes a second, whatever comes on it.
// Over a ByteStream and a Clock only.
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

// How fast a line may be read, over all its connections: a line that is cut and opened again has no
// more than one that stays. Thread-bound; allocates nothing after its making.
class ReadPace {
 public:
  // Up to a quarter of a second's bytes may come at once, 4 KiB (a pty's buffer) at least and
  // 64 KiB at most. `changed` is called when the line begins or ceases to send more than that.
  // REQUIRES: bytes_s > 0.
  ReadPace(double bytes_s, std::function<void()> changed);

  // Whether more comes than is read: since the bytes of a connection had to wait, and until half of
  // what may come at once was saved up again.
  bool above() const noexcept { return above_; }
  // "sends more than 15.4 kB/s: read at that pace".
  const std::string& sentence() const noexcept { return sentence_; }

  // How many bytes may be read at `now`; where it is none, the line is above its pace.
  std::size_t allowed(Timestamp now);
  // How long a read waits then: a few bytes at once cost less than each alone.
  static constexpr Duration kPause = std::chrono::milliseconds(10);
  // Subtracts bytes that were read from the allowance.
  void charge(std::size_t bytes, Timestamp now) noexcept;

 private:
  void setAbove(bool above);

  // While it waits: until a pause's bytes are there. Else each byte would be read as it is allowed,
  // and a system call takes as long as that.
  double burst_, step_;
  bool waits_ = false;
  TokenBucket bucket_;
  std::function<void()> changed_;
  std::string sentence_;
  bool above_ = false;
};

// Reads ahead, a KiB at most, so that a dialogue that takes single bytes costs a system call for
// many. What was read ahead is lost with the stream. Thread-bound but for interrupt().
class PacedStream final : public ByteStream {
 public:
  // `pace` and `clock` outlive this.
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
  std::size_t next_ = 0, end_ = 0;     // of ahead_: what is not handed out yet
};

}  // namespace merlin
