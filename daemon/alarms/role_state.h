// RoleState: decides whether a role of merlind is missing and this is to be reported. Pure.
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
  // missing even if it has never run. `now`: when the observation begins.
  RoleState(std::string role, bool expected, Timestamp now)
      : role_(std::move(role)), expected_(expected), started_(now) {}

  // Returns a sentence to be reported, once for each event: that the role has ended, has never run,
  // runs again, or restarts repeatedly; otherwise nothing. To be called periodically. `generation`:
  // that of its present run; 0: it does not run.
  std::optional<std::string> update(std::uint64_t generation, Timestamp now);

  // Time for the first start, since a role reads large models and compiles shaders before it runs.
  static constexpr Duration kFirstStart = std::chrono::minutes(3);
  // A role that runs again within this time was restarted, which is not reported.
  static constexpr Duration kRestart = std::chrono::seconds(15);
  // A role that starts kOftenStarts times within kOften is reported as restarting repeatedly.
  static constexpr Duration kOften = std::chrono::minutes(10);
  static constexpr std::size_t kOftenStarts = 5;

 private:
  std::optional<std::string> missed(Timestamp now);

  std::string role_;
  bool expected_;
  Timestamp started_;
  std::optional<Timestamp> last_ran_;
  std::uint64_t generation_ = 0;
  std::deque<Timestamp> runs_;  // start times of the runs that began within the last kOften
  bool missing_ = false;
};

}  // namespace merlin::alarms
