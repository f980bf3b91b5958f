// Migration of /devices, which was an object with a place for one glove, one tracker and one ball,
// and is a list now.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"

namespace merlin {

// Converts the object /devices to the list and moves its other settings to groups beside it;
// returns whether there was such an object. Adds a sentence to `notes` for everything that is not
// kept unchanged. Errors: kInvalidArgument (a setting is there in its old and its new form, or a
// device or the hand is not an object); `root` is then as it was.
Result<bool> moveDevices(nlohmann::ordered_json& root, std::vector<std::string>& notes);

}  // namespace merlin
