// A daemon's status: the JSON of both roles in one object, and as text for a person.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"

namespace merlin::cli {

// Asks both roles and merges their documents into one object; keys that both have (pid, uptime_s)
// go into "roles". Errors: kIo (no daemon), kTimeout (it does not answer).
Result<nlohmann::ordered_json> askStatus(const std::string& instance);

// Merges one role's document (topic "status") into the object of both roles.
void mergeStatus(nlohmann::ordered_json& both, const std::string& document);

// The status as a table of several lines.
std::string statusTable(const nlohmann::ordered_json& status);

// A bar chart of frames by work / period. `buckets`: counts for each 1/16 of the period; one line
// for each 1/8. Empty if there were no frames.
std::string histogramChart(const std::vector<std::uint32_t>& buckets);

// The status as one line: desired and actual rate, triangles, late frames, posture, devices.
std::string statusLine(const nlohmann::ordered_json& status);

}  // namespace merlin::cli
