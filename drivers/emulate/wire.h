// Wire: computes how long bytes take on a serial line, so that an emulator does not send faster
// than its baud rate allows.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "daemon/base/clock.h"
#include "daemon/base/random.h"

namespace merlin::emulate {

// If the process wakes up late, the emulator sends the records that the device would have sent
// meanwhile, but at most those of this last period, which fit into the buffer of a serial port.
inline constexpr Duration kLongestDelay = std::chrono::seconds(1);

class Wire {
 public:
  // A byte takes ten bits on the line (8N1). Before every `garbage_every`-th record, a burst of 1
  // to 12 random bytes is sent; 0: never.
  Wire(int baud, int garbage_every, std::uint64_t seed)
      : byte_time_(std::chrono::nanoseconds(10'000'000'000 / baud)),
        garbage_every_(garbage_every),
        random_(seed) {}

  bool free(Timestamp now) const noexcept { return now >= busy_until_; }
  Timestamp freeAt() const noexcept { return busy_until_; }

  // Sends a reply to a command: it is never dropped, and follows the bytes that are under way.
  void reply(std::string_view bytes, Timestamp now, std::string& out) {
    occupy(bytes.size(), now);
    out += bytes;
  }

  // Sends a record of a stream. REQUIRES: free(now).
  void record(std::string_view bytes, Timestamp now, std::string& out) {
    if (garbage_every_ > 0 && ++records_ % garbage_every_ == 0) {
      const auto burst = 1 + random_.below(12);
      for (std::uint64_t i = 0; i < burst; ++i) out.push_back(static_cast<char>(random_.next()));
      occupy(burst, now);
    }
    occupy(bytes.size(), now);
    out += bytes;
  }

 private:
  void occupy(std::size_t bytes, Timestamp now) {
    busy_until_ = std::max(busy_until_, now) + byte_time_ * static_cast<std::int64_t>(bytes);
  }

  Duration byte_time_;
  int garbage_every_;
  Random random_;
  int records_ = 0;
  Timestamp busy_until_{};
};

}  // namespace merlin::emulate
