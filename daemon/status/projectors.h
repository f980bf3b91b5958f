// The projectors in a role's status.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace merlin::status {

struct ProjectorStatus {
  std::string name{}, kind{};  // "gpio" or "pjlink"
  // off, warming, on, cooling, unknown; `wanted`: empty if `power` is as wanted.
  std::string power{}, wanted{};
  std::string health{}, reason{};  // "ok", "unreachable"
  std::string address{}, identity{};
  std::vector<int> lamp_hours{};     // of each lamp
  std::optional<double> within_s{};  // longest time until it reaches the power state that it is
                                     // changing to, or that is wanted
};

// When the schedule switches all projectors next.
struct ProjectorSwitching {
  std::int64_t local_minute = 0;  // minutes from 1970-01-01 00:00 on the local calendar
  bool on = false;
};

// Returns `document`, a JSON object, with the member "projectors" added if there are any:
// {"left": {"kind": "pjlink", "power": "on", "health": "ok", ...}}, and with "projector_schedule"
// if a switching is due: {"at": "2026-11-24T18:00", "on": false}, local time.
std::string addProjectors(const std::string& document,
                          const std::vector<ProjectorStatus>& projectors,
                          const std::optional<ProjectorSwitching>& next = {});

// The projectors in a document that addProjectors() wrote, with name, power and wanted alone; none
// if it has none, or is not JSON.
std::vector<ProjectorStatus> projectorsIn(const std::string& document);

}  // namespace merlin::status
