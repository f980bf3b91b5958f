#include "drivers/port/dialogue.h"

#include <algorithm>

#include <fmt/format.h>

namespace merlin {
namespace {

constexpr Duration kWriteTimeout = std::chrono::seconds(1);
constexpr Duration kGap = std::chrono::milliseconds(100);  // longest gap within an answer

Error timedOut(std::string_view step, Duration timeout, std::string_view got) {
  return {Errc::kTimeout, fmt::format("no answer to {} within {:.1f} s{}", step, toSeconds(timeout),
                                      got.empty() ? "" : ", only \"" + quoteBytes(got) + "\"")};
}

}  // namespace

std::string quoteBytes(std::string_view bytes) {
  std::string out;
  for (const char c : bytes.substr(0, 24)) {
    const auto u = static_cast<unsigned char>(c);
    out += u >= 0x20 && u < 0x7F ? std::string(1, c) : fmt::format("\\x{:02X}", u);
  }
  return bytes.size() > 24 ? out + "..." : out;
}

Result<Ok> Dialogue::send(std::string_view bytes) {
  const auto written = stream_.write(std::as_bytes(std::span(bytes)), kWriteTimeout);
  if (!written) return written.error();
  return Ok{};
}

Result<char> Dialogue::next(Timestamp deadline) {
  const Duration left = deadline - clock_.now();
  if (left <= Duration::zero()) return Error{Errc::kTimeout, "time-out"};
  std::byte byte{};
  const auto got = stream_.read(std::span(&byte, 1), left);
  if (!got) return got.error();
  return static_cast<char>(byte);
}

Result<std::string> Dialogue::readExactly(std::size_t count, Duration timeout,
                                          std::string_view step) {
  Timestamp deadline = clock_.now() + timeout;
  std::string bytes;
  while (bytes.size() < count) {
    const auto c = next(deadline);
    if (!c && c.error().code == Errc::kTimeout) return timedOut(step, timeout, bytes);
    if (!c) return c.error();
    bytes.push_back(*c);
    deadline = std::max(deadline, clock_.now() + kGap);
  }
  return bytes;
}

Result<std::string> Dialogue::readUntil(char end, std::size_t limit, Duration timeout,
                                        std::string_view step) {
  Timestamp deadline = clock_.now() + timeout;
  std::string bytes;
  for (;;) {
    const auto c = next(deadline);
    if (!c && c.error().code == Errc::kTimeout) return timedOut(step, timeout, bytes);
    if (!c) return c.error();
    if (*c == end) return bytes;
    if (bytes.size() == limit) {
      return Error{Errc::kMalformed, fmt::format("more than {} bytes in the answer to {}: \"{}\"",
                                                 limit, step, quoteBytes(bytes))};
    }
    bytes.push_back(*c);
    deadline = std::max(deadline, clock_.now() + kGap);
  }
}

Result<std::size_t> Dialogue::drain(Duration quiet, Duration most) {
  const Timestamp deadline = clock_.now() + most;
  std::size_t dropped = 0;
  std::byte buffer[256];
  for (;;) {
    const Duration left = std::min<Duration>(quiet, deadline - clock_.now());
    if (left <= Duration::zero()) return dropped;
    const auto got = stream_.read(buffer, left);
    if (!got && got.error().code == Errc::kTimeout) return dropped;
    if (!got) return got.error();
    dropped += *got;
  }
}

}  // namespace merlin
