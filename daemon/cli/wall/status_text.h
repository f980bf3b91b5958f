// Merges the status of both roles of a daemon into one JSON object, and formats it for a person.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"
#include "daemon/cli/roles.h"

namespace merlin::cli {

// Asks each running role of an instance on this machine for its status and merges the documents
// into one object (mergeStatus()). A lost role is in "lost_roles"/ROLE, with "silent_s" and a
// "reason" such as "does not run; it ended 12 s ago". Errors: kIo (no daemon runs), kTimeout (a
// role does not answer).
Result<nlohmann::ordered_json> askStatus(const std::string& instance);
// Asks the roles of a daemon on this or another machine and merges the documents. Lost roles are
// reported only for this machine. Errors: those of findRoles(); kTimeout.
Result<nlohmann::ordered_json> askStatus(const DaemonAddress& daemon);

// Merges the status document of one role into `both`, the object of both roles. The keys pid,
// uptime_s and services, which both roles have, are moved to "roles"/ROLE. The top-level "services"
// lists those of both roles; of two services with the same name, the failed one. A document that is
// not a JSON object is ignored.
void mergeStatus(nlohmann::ordered_json& both, const std::string& document);

// Adds the lost roles of an instance on this machine to `both`, in the form that askStatus()
// describes.
void addLostRoles(const std::string& instance, nlohmann::ordered_json& both);

// Returns the status as a table of several lines.
std::string statusTable(const nlohmann::ordered_json& status);

// Returns a histogram of the frames by their work, as a share of the period, drawn as a bar chart.
// `buckets`: number of frames for each 1/16 of the period; the chart has one line for each 1/8. The
// text is empty if there were no frames.
std::string histogramChart(const std::vector<std::uint32_t>& buckets);

// Returns the status as one line: desired and actual rate, triangles, late frames, posture,
// devices, and the services that have failed.
std::string statusLine(const nlohmann::ordered_json& status);

}  // namespace merlin::cli
