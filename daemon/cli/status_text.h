// A daemon's status as JSON of both roles, and as a table for a person.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"

namespace merlin::cli {

// One object: the wall's and the devices' documents side by side, with "roles" for what both have.
// Errors: no daemon (kIo), one that does not answer (kTimeout).
Result<nlohmann::ordered_json> askStatus(const std::string& instance);

// Adds one role's document ("status" topic) to the object of both.
void mergeStatus(nlohmann::ordered_json& both, const std::string& document);

// Some lines.
std::string statusTable(const nlohmann::ordered_json& status);

// Frames by work / period, 1/16 a bucket, as bars of eighths; empty where there were none.
std::string histogramChart(const std::vector<std::uint32_t>& buckets);

// One line: rate asked and held, triangles, frames late, posture, devices.
std::string statusLine(const nlohmann::ordered_json& status);

}  // namespace merlin::cli
