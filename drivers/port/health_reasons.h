// Reasons in DeviceHealth of a device that is absent as it should be.
#pragma once

#include <string_view>

namespace merlin {

inline constexpr std::string_view kNotConfigured = "not configured";  // its entry names no port
// It is configured, and its process has not tried to open it since it started.
inline constexpr std::string_view kNotOpenedYet = "not opened yet";
inline constexpr std::string_view kStopped = "stopped";  // its process ends, or closes the line

}  // namespace merlin
