// The projectors in a role's status.
#pragma once

#include <string>
#include <vector>

namespace merlin::status {

struct ProjectorStatus {
  std::string name{}, kind{};      // "gpio" or "pjlink"
  std::string power{}, wanted{};   // off, warming, on, cooling, unknown; wanted: empty if it is
  std::string health{}, reason{};  // "ok", "unreachable"
  std::string address{}, identity{};
  std::vector<int> lamp_hours{};  // of each lamp
};

// Returns `document`, a JSON object, with the member "projectors" added if there are any:
// {"left": {"kind": "pjlink", "power": "on", "health": "ok", ...}}.
std::string addProjectors(const std::string& document,
                          const std::vector<ProjectorStatus>& projectors);

}  // namespace merlin::status
