// RoleState: decides whether a role of merlind is missing and somebody is to be told of it. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "daemon/base/clock.h"

namespace merlin::alarms {

class RoleState {
 public:
  // `expected`: the configuration has work for the role on this machine, so it is reported as
  // missing also if it never came. `now`: when the observation begins.
  RoleState(std::string role, bool expected, Timestamp now)
      : role_(std::move(role)), expected_(expected), started_(now) {}

  // Returns a sentence to be told, each once: that the role ended, never came, is back, or restarts
  // again and again. `generation`: that of its present run; 0: it does not run.
  std::optional<std::string> update(std::uint64_t generation, Timestamp now);

  // Time for the first start, since a role reads large models and compiles shaders before it runs.
  static constexpr Duration kFirstStart = std::chrono::minutes(3);
  // A role that is back within this time was restarted, and nobody is told.
  static constexpr Duration kRestart = std::chrono::seconds(15);
  // A role that starts kOftenStarts times within kOften restarts again and again.
  static constexpr Duration kOften = std::chrono::minutes(10);
  static constexpr std::size_t kOftenStarts = 5;

 private:
  std::optional<std::string> missed(Timestamp now);

  std::string role_;
  bool expected_;
  Timestamp started_;
  std::optional<Timestamp> last_ran_;
  std::uint64_t generation_ = 0;
  std::deque<Timestamp> runs_;  // when each of the last kOften began
  bool missing_ = false;
};

}  // namespace merlin::alarms
