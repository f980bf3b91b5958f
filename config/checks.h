// What no single setting can be wrong about: values that must fit one another.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/loader.h"

namespace merlin {

// Appends findings; `lines` says where each setting of the file stands, by pointer.
void checkTogether(const Settings& settings, const std::map<std::string, int>& lines,
                   std::vector<Finding>& findings);

}  // namespace merlin
