#include "daemon/status/ended_threads.h"

#include <fmt/format.h>

namespace merlin::status {
namespace {

constexpr Duration kUntilHeard = std::chrono::milliseconds(500);

}  // namespace

std::optional<Error> EndedThreads::check(Timestamp now) {
  for (const ThreadState& thread : watch_.threads()) {
    if (!thread.ended) continue;
    if (!seen_) {
      seen_ = now;
      services_.failed("thread " + thread.name, thread.reason);
    }
    if (now - *seen_ < kUntilHeard) return std::nullopt;
    return Error{Errc::kIo,
                 fmt::format("the thread \"{}\" has ended: {}", thread.name, thread.reason)};
  }
  return std::nullopt;
}

}  // namespace merlin::status
