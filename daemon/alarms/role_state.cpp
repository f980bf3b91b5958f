#include "daemon/alarms/role_state.h"

#include <utility>

#include <fmt/format.h>

namespace merlin::alarms {

std::optional<std::string> RoleState::update(std::uint64_t generation, Timestamp now) {
  if (generation == 0) return missed(now);
  last_ran_ = now;
  if (std::exchange(generation_, generation) != generation) runs_.push_back(now);
  while (!runs_.empty() && now - runs_.front() > kOften) runs_.pop_front();
  if (std::exchange(missing_, false)) return fmt::format("the role {} runs again", role_);
  if (runs_.size() < kOftenStarts) return std::nullopt;
  const std::size_t starts = runs_.size();
  runs_.clear();  // the count begins again
  return fmt::format(
      "the role {} was started {} times within {:.0f} minutes: it does not keep running", role_,
      starts, toSeconds(kOften) / 60);
}

std::optional<std::string> RoleState::missed(Timestamp now) {
  const bool came = last_ran_.has_value();
  const Duration patience = came ? kRestart : kFirstStart;
  if (missing_ || (!came && !expected_) || now - last_ran_.value_or(started_) < patience)
    return std::nullopt;
  missing_ = true;
  return came ? fmt::format("the role {} has not run for {:.0f} s", role_, toSeconds(patience))
              : fmt::format("the role {} has not run since the alarms were started {:.0f} s ago",
                            role_, toSeconds(patience));
}

}  // namespace merlin::alarms
