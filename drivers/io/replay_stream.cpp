#include "drivers/io/replay_stream.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace merlin::io {
namespace {

constexpr Duration kHostPatience = std::chrono::seconds(2);

}  // namespace

Player::Player(Transcript transcript, Timestamp start)
    : transcript_(std::move(transcript)), base_(start) {
  skipHost(start);
}

// A chunk of the host is complete when the host has sent the same number of bytes; the transcript's
// time then continues from the time of that chunk.
void Player::hostSaid(std::size_t bytes, Timestamp now) {
  while (bytes > 0 && !ended() && transcript_.chunks[next_].to_device) {
    const std::size_t taken = std::min(bytes, host_owes_);
    host_owes_ -= taken;
    bytes -= taken;
    if (host_owes_ > 0) return;
    base_ = now - transcript_.chunks[next_].at;
    ++next_;
    skipHost(now);
  }
}

// If the next chunk is the host's, sets host_owes_; skips empty chunks of the host.
void Player::skipHost(Timestamp now) {
  while (!ended() && transcript_.chunks[next_].to_device) {
    host_owes_ = transcript_.chunks[next_].bytes.size();
    if (host_owes_ > 0) return;
    base_ = now - transcript_.chunks[next_].at;
    ++next_;
  }
}

void Player::advance(Timestamp now, std::string& out) {
  while (!ended()) {
    const TranscriptChunk& chunk = transcript_.chunks[next_];
    if (chunk.to_device) {
      if (now < base_ + chunk.at + kHostPatience) return;
      base_ = now - chunk.at;  // the host will not send it
      ++next_;
    } else {
      if (now < base_ + chunk.at) return;
      out += chunk.bytes;
      ++next_;
    }
    skipHost(now);
  }
}

Timestamp Player::nextDue() const {
  if (ended()) return Timestamp::max();
  const TranscriptChunk& chunk = transcript_.chunks[next_];
  return base_ + chunk.at + (chunk.to_device ? kHostPatience : Duration::zero());
}

Result<std::size_t> ReplayStream::read(std::span<std::byte> buffer, Duration timeout) {
  const Timestamp deadline = clock_.now() + timeout;
  for (;;) {
    if (stop_.stop_requested()) return Error{Errc::kClosed, "interrupted"};
    player_.advance(clock_.now(), ready_);
    if (!ready_.empty()) break;
    if (player_.ended()) return Error{Errc::kClosed, "end of the transcript"};
    if (clock_.now() >= deadline) return Error{Errc::kTimeout, "time-out"};
    clock_.sleepUntil(std::min(deadline, player_.nextDue()), stop_.get_token());
  }
  const std::size_t n = std::min(buffer.size(), ready_.size());
  std::memcpy(buffer.data(), ready_.data(), n);
  ready_.erase(0, n);
  return n;
}

Result<std::size_t> ReplayStream::write(std::span<const std::byte> bytes, Duration) {
  if (stop_.stop_requested()) return Error{Errc::kClosed, "interrupted"};
  player_.hostSaid(bytes.size(), clock_.now());
  return bytes.size();
}

}  // namespace merlin::io
