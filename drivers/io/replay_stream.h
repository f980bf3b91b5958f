// ReplayStream: a transcript as the line that it was recorded from.
#pragma once

#include <stop_token>

#include "drivers/io/transcript.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

// The order and the pace of a transcript: what comes when, and after which of the host's bytes.
// Bytes that followed the host's come as long after the host's bytes now as they did then; a host
// that says less than it did then is waited for two seconds, and then no more. Pure but for the
// times that it is told. Thread-bound.
class Player {
 public:
  Player(Transcript transcript, Timestamp start);

  void hostSaid(std::size_t bytes, Timestamp now);

  // Appends what the device sent until `now`.
  void advance(Timestamp now, std::string& out);
  // When more comes, if the host says nothing; Timestamp::max() once all has come.
  Timestamp nextDue() const;
  bool ended() const { return next_ == transcript_.chunks.size(); }

 private:
  void skipHost(Timestamp now);

  Transcript transcript_;
  std::size_t next_ = 0;       // chunk
  Timestamp base_;             // when the transcript's time 0 would have been
  std::size_t host_owes_ = 0;  // bytes of the chunk `next_` that the host has not said yet
};

// `clock` outlives this. Ends with kClosed after the last byte.
class ReplayStream final : public ByteStream {
 public:
  ReplayStream(Transcript transcript, Clock& clock)
      : clock_(clock), player_(std::move(transcript), clock.now()) {}

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override;
  Result<std::size_t> write(std::span<const std::byte> bytes, Duration timeout) override;
  void interrupt() noexcept override { stop_.request_stop(); }

 private:
  Clock& clock_;
  Player player_;
  std::string ready_;
  std::stop_source stop_;
};

}  // namespace merlin::io
