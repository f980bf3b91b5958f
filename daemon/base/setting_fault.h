// SettingFault: an invalid value in a group of settings, with its place in the group.
#pragma once

#include <string>
#include <vector>

namespace merlin {

struct SettingFault {
  std::string pointer;     // JSON pointer relative to the group, "/tiles/2"; empty: the group
  std::string what;        // what is wrong, with the figures
  std::string other = {};  // another setting of the group that it conflicts with; empty: none
};

using SettingFaults = std::vector<SettingFault>;

}  // namespace merlin
