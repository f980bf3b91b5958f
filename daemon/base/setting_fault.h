// SettingFault: what is wrong with a group of settings, wherever in it that is.
#pragma once

#include <string>
#include <vector>

namespace merlin {

struct SettingFault {
  std::string pointer;  // below the group, "/tiles/2"; empty: the group itself
  std::string what;     // with the figures
};

using SettingFaults = std::vector<SettingFault>;

}  // namespace merlin
