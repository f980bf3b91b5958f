// A daemon's status: merges the JSON of both roles into one object, and formats it for a person.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"
#include "daemon/cli/roles.h"

namespace merlin::cli {

// Asks each running role for its status and merges the documents into one object. The keys pid and
// uptime_s, which both roles have, are moved to "roles"/ROLE. A lost role of this machine is in
// "lost_roles"/ROLE: "silent_s" and a "reason", such as "does not run; it ended 12 s ago". Errors:
// kIo (no daemon runs), kTimeout (a role does not answer).
Result<nlohmann::ordered_json> askStatus(const std::string& instance);
// The same for any daemon.
Result<nlohmann::ordered_json> askStatus(const DaemonAddress& daemon);

// Merges one role's status document into `both`, the object of both roles. A document that is not a
// JSON object is ignored. The services of each role are kept in "roles"/ROLE/"services"; "services"
// has those of both roles; if two have the same name, the one that has failed.
void mergeStatus(nlohmann::ordered_json& both, const std::string& document);

// Adds the lost roles of this instance to `both`, as askStatus() does.
void addLostRoles(const std::string& instance, nlohmann::ordered_json& both);

// The status as a table of several lines.
std::string statusTable(const nlohmann::ordered_json& status);

// A histogram of the frames by their work as a share of the period, as a bar chart. `buckets`:
// number of frames for each 1/16 of the period; the chart has one line for each 1/8. Empty if there
// were no frames.
std::string histogramChart(const std::vector<std::uint32_t>& buckets);

// The status as one line: desired and actual rate, triangles, late frames, posture, devices, and
// the services that have failed.
std::string statusLine(const nlohmann::ordered_json& status);

}  // namespace merlin::cli
