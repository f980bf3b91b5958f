// Turns: whose input counts when several people act on the wall at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"

namespace merlin::wall {

// The first person who acts has the wall, until that person has not acted for a while; then anybody
// may take it. Pure; thread-bound.
class Turns {
 public:
  // `after`: how long a person keeps the wall after the last act.
  explicit Turns(Duration after) : after_(after) {}

  void setAfter(Duration after) { after_ = after; }

  // `acting`: the people who act now. Returns the one who has the wall; nothing if nobody has.
  const std::optional<std::string>& update(Timestamp now, const std::vector<std::string>& acting);

 private:
  Duration after_;
  std::optional<std::string> holder_;
  Timestamp last_{};  // when the holder acted
};

}  // namespace merlin::wall
