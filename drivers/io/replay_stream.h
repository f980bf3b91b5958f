// ReplayStream: replays a transcript as if it were the line from which it was recorded.
#pragma once

#include <stop_token>

#include "drivers/io/transcript.h"
#include "drivers/port/byte_stream.h"

namespace merlin::io {

// Player: determines order and timing of a replay, that is, when each byte of the device is due and
// after which bytes of the host. Device bytes that followed host bytes in the recording follow them
// with the same delay. If the host sends fewer bytes than in the recording, the player waits two
// seconds for them, then continues. Pure: the time is passed in. Thread-bound.
class Player {
 public:
  Player(Transcript transcript, Timestamp start);

  // To be called when the host has sent `bytes` further bytes.
  void hostSaid(std::size_t bytes, Timestamp now);

  // Appends the device's bytes that are due at `now`.
  void advance(Timestamp now, std::string& out);
  // Returns when the next bytes are due if the host sends nothing; Timestamp::max() after the end.
  Timestamp nextDue() const;
  bool ended() const { return next_ == transcript_.chunks.size(); }

 private:
  void skipHost(Timestamp now);

  Transcript transcript_;
  std::size_t next_ = 0;       // index of the next chunk
  Timestamp base_;             // the moment that corresponds to the transcript's time 0
  std::size_t host_owes_ = 0;  // bytes of chunk `next_` that the host has not sent yet
};

// A ByteStream that replays a transcript by `clock`, which must outlive this object. After the last
// byte, read() returns kClosed.
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
