// Writes the projectors into a role's status document, and reads them from it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace merlin::status {

struct ProjectorStatus {
  std::string name{}, kind{};  // kind: "gpio" or "pjlink"
  // `power`: "off", "warming", "on", "cooling" or "unknown". `wanted`: "on" or "off"; empty if
  // `power` is as wanted.
  std::string power{}, wanted{};
  std::string health{}, reason{};  // "ok", "unreachable"
  std::string address{}, identity{};
  std::vector<int> lamp_hours{};     // hours of use of each lamp
  std::optional<double> within_s{};  // longest time until it reaches the power state that it is
                                     // changing to, or that is wanted
};

// The next time at which the schedule switches all projectors.
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

// Returns the projectors in a document that addProjectors() wrote, with only `name`, `power` and
// `wanted` set; none if the document has none or is not JSON.
std::vector<ProjectorStatus> projectorsIn(const std::string& document);

}  // namespace merlin::status
