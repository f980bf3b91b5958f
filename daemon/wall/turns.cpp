#include "daemon/wall/turns.h"

#include <algorithm>

namespace merlin::wall {

const std::optional<std::string>& Turns::update(Timestamp now,
                                                const std::vector<std::string>& acting) {
  if (holder_ && std::find(acting.begin(), acting.end(), *holder_) != acting.end()) {
    last_ = now;
    return holder_;
  }
  if (holder_ && now - last_ < after_) return holder_;
  holder_.reset();
  if (acting.empty()) return holder_;
  holder_ = acting.front();
  last_ = now;
  return holder_;
}

}  // namespace merlin::wall
