// Adds a member to a status document.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace merlin::status {

// Returns `document`, a JSON object, with the member `name` set to `value`; a new member is put at
// the end. Returns `document` unchanged if `value` is empty or `document` is not a JSON object.
std::string addMember(const std::string& document, const char* name, nlohmann::ordered_json value);

}  // namespace merlin::status
