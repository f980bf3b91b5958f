// Turns: decides whose input counts when several people act on the wall at the same time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"

namespace merlin::wall {

// The first person who acts has the wall, i.e. only this person's input counts, until this person
// has not acted for a while; then the next person who acts has the wall. Pure; thread-bound.
class Turns {
 public:
  // `after`: time after a person's last action until another person may take the wall.
  explicit Turns(Duration after) : after_(after) {}

  void setAfter(Duration after) { after_ = after; }

  // `acting`: the people who act at `now`. Returns the person who has the wall; nothing if nobody
  // has it. To be called once a frame.
  const std::optional<std::string>& update(Timestamp now, const std::vector<std::string>& acting);

 private:
  Duration after_;
  std::optional<std::string> holder_;
  Timestamp last_{};  // when the holder acted last
};

}  // namespace merlin::wall
