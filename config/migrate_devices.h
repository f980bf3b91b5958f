// Migration of /devices: in earlier versions it was an object for one glove, one tracker and one
// ball; now it is a list of devices.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"

namespace merlin {

// Converts the object /devices of `root` to the list, and moves the other settings in the object to
// groups beside the list. Returns false, without a change, if /devices is not an object. Adds a
// sentence to `notes` for driver settings that are left out and for devices that are added to the
// list. Errors: kInvalidArgument (`root` contains a setting both in its old and in its new form, or
// a device or the hand is not an object); `root` is then unchanged.
Result<bool> moveDevices(nlohmann::ordered_json& root, std::vector<std::string>& notes);

}  // namespace merlin
