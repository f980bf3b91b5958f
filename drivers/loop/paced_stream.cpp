#include "drivers/loop/paced_stream.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace merlin {
namespace {

constexpr double kLeastBurst = 4096, kMostBurst = 65536;  // bytes
constexpr double kBurst_s = 0.25;

std::string sentenceOf(double bytes_s) {
  const bool kilo = bytes_s >= 1000, mega = bytes_s >= 1e6;
  return fmt::format("sends more than {:.3g} {}B/s, the limit at which it is read",
                     bytes_s / (mega   ? 1e6
                                : kilo ? 1e3
                                       : 1),
                     mega   ? "M"
                     : kilo ? "k"
                            : "");
}

}  // namespace

ReadPace::ReadPace(double bytes_s, std::function<void()> changed)
    : burst_(std::clamp(kBurst_s * bytes_s, kLeastBurst, kMostBurst)),
      step_(std::clamp(bytes_s * toSeconds(kPause), 1.0, burst_ / 2)),
      bucket_(bytes_s, burst_),
      changed_(std::move(changed)),
      sentence_(sentenceOf(bytes_s)) {}

std::size_t ReadPace::allowed(Timestamp now) {
  const double bytes = bucket_.available(now);
  if (bytes < step_ / 4) waits_ = true;
  if (bytes >= step_) waits_ = false;
  if (waits_) setAbove(true);
  if (bytes >= burst_ / 2) setAbove(false);
  return waits_ || bytes < 1 ? 0 : static_cast<std::size_t>(bytes);
}

void ReadPace::charge(std::size_t bytes, Timestamp now) noexcept {
  bucket_.charge(static_cast<double>(bytes), now);
}

void ReadPace::setAbove(bool above) {
  if (std::exchange(above_, above) != above) changed_();
}

// NOLINTNEXTLINE(*-member-init): ahead_ is filled by read()
PacedStream::PacedStream(std::unique_ptr<ByteStream> inner, ReadPace& pace, Clock& clock)
    : inner_(std::move(inner)), pace_(pace), clock_(clock) {}

Result<std::size_t> PacedStream::read(std::span<std::byte> buffer, Duration timeout) {
  if (interrupted_.stop_requested()) return Error{Errc::kClosed, "interrupted"};
  if (next_ == end_) {
    if (const auto filled = fill(timeout); !filled) return filled.error();
  }
  const std::size_t n = std::min(buffer.size(), end_ - next_);
  std::copy_n(&ahead_[next_], n, buffer.begin());
  next_ += n;
  return n;
}

Result<Ok> PacedStream::fill(Duration timeout) {
  const Timestamp deadline = clock_.now() + timeout;
  std::size_t allowed = pace_.allowed(clock_.now());
  while (allowed == 0) {
    const Timestamp now = clock_.now();
    // The text is so short that it needs no allocation.
    if (now >= deadline) return Error{Errc::kTimeout, "time-out"};
    if (!clock_.sleepUntil(std::min(now + ReadPace::kPause, deadline), interrupted_.get_token()))
      return Error{Errc::kClosed, "interrupted"};
    allowed = pace_.allowed(clock_.now());
  }
  const auto got = inner_->read(std::span(ahead_).first(std::min(allowed, ahead_.size())),
                                std::max<Duration>(deadline - clock_.now(), Duration::zero()));
  if (!got) return got.error();
  next_ = 0;
  end_ = *got;
  pace_.charge(*got, clock_.now());
  return Ok{};
}

Result<std::size_t> PacedStream::write(std::span<const std::byte> bytes, Duration timeout) {
  return inner_->write(bytes, timeout);
}

void PacedStream::interrupt() noexcept {
  interrupted_.request_stop();
  inner_->interrupt();
}

}  // namespace merlin
