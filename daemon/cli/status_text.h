// A daemon's status as JSON of both roles, and as a table for a person.
#pragma once

#include <string>

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

// One line: rate asked and held, triangles, frames late, posture, devices.
std::string statusLine(const nlohmann::ordered_json& status);

}  // namespace merlin::cli
