#include "daemon/status/watchdog.h"

namespace merlin::status {

bool Watchdog::ping(Timestamp now, const std::vector<ThreadState>& threads) {
  if (interval_ == Duration::zero() || now - last_ < interval_) return false;
  for (const ThreadState& thread : threads) {
    const auto seen = seen_.find(thread.id);
    const bool stands = seen != seen_.end() && thread.progress <= seen->second;
    if (thread.ended || (stands && !thread.paused)) return false;
  }
  seen_.clear();
  for (const ThreadState& thread : threads) seen_[thread.id] = thread.progress;
  last_ = now;
  return true;
}

}  // namespace merlin::status
