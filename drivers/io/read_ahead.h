// ReadAhead: buffer for bytes that a stream has read but not returned yet.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

namespace merlin::io {

struct ReadAhead {
  std::string bytes;  // those from index `next` on have not been returned yet
  std::size_t next = 0;

  bool empty() const noexcept { return next == bytes.size(); }
  void clear() noexcept {
    bytes.clear();
    next = 0;
  }
  // Moves as many bytes as fit into `buffer`; returns their number.
  std::size_t take(std::span<std::byte> buffer) noexcept {
    const std::size_t n = std::min(buffer.size(), bytes.size() - next);
    std::memcpy(buffer.data(), bytes.data() + next, n);
    next += n;
    return n;
  }
};

}  // namespace merlin::io
