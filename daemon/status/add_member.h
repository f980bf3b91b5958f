// Adds a member to a status document.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace merlin::status {

// Returns `document` with the member `name`, at its end, if `value` is not empty. A text that is
// not a JSON object is returned as it is.
std::string addMember(const std::string& document, const char* name, nlohmann::ordered_json value);

}  // namespace merlin::status
