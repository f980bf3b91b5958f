#include "daemon/status/watchdog.h"

namespace merlin::status {

bool Watchdog::ping(Timestamp now, std::span<const std::uint64_t> counters) {
  if (interval_ == Duration::zero() || now - last_ < interval_) return false;
  for (std::size_t i = 0; i < seen_.size() && i < counters.size(); ++i) {
    if (counters[i] <= seen_[i]) return false;
  }
  seen_.assign(counters.begin(), counters.end());
  last_ = now;
  return true;
}

}  // namespace merlin::status
