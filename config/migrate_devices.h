// Migration of /devices, which was an object with a place for one glove, one tracker and one ball,
// and is a list now.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"

namespace merlin {

// Makes the list of the object /devices and moves what else was in it to the settings beside it;
// returns whether there was such an object. Adds a sentence to `notes` for all that is not kept as
// it was. Errors: kInvalidArgument (a setting is there in its old and its new form, or a device or
// the hand is not an object); `root` is then as it was.
Result<bool> moveDevices(nlohmann::ordered_json& root, std::vector<std::string>& notes);

}  // namespace merlin
