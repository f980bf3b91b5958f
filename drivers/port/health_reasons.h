// Texts of DeviceHealth::reason for a device whose absence is not a fault.
#pragma once

#include <string_view>

namespace merlin {

inline constexpr std::string_view kNotConfigured = "not configured";  // the device has no port
// It is configured, but its process has not tried to open it since the process started.
inline constexpr std::string_view kNotOpenedYet = "not opened yet";
inline constexpr std::string_view kStopped = "stopped";  // its process ends, or closes the line

}  // namespace merlin
