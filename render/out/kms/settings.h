// Settings of an output of kind kms.
#pragma once

#include <optional>
#include <string>

#include "daemon/base/setting_fault.h"

namespace merlin::render::out::kms {

inline constexpr const char* kEveryConnector = "*";

struct KmsSettings {
  std::string card{};  // path of its device file; empty: the first card that has connectors
  // Name of the connector, "HDMI-A-1"; empty: the first one with a display; kEveryConnector: all
  // connectors of the card.
  std::string connector{};
  std::string mode{};  // "1920x1080" or "1920x1080@60"; empty: see chooseMode()

  bool isEvery() const { return connector == kEveryConnector; }
  bool operator==(const KmsSettings&) const = default;
};

// The mode that a name such as "1920x1080@60" asks for.
struct WantedMode {
  int width = 0, height = 0;  // [px]
  double refresh_hz = 0;      // 0: any
};
// Parses a mode's name, WIDTHxHEIGHT or WIDTHxHEIGHT@HZ. Returns nothing if it is malformed, a side
// exceeds 32768 px, or the rate exceeds 1000 Hz.
std::optional<WantedMode> parseMode(const std::string& name);

// Checks for: a card that is not the path of a device file, a mode's name that parseMode() cannot
// read, a connector's name with characters that no connector has. Whether these exist is found out
// only when the wall runs. Pure.
SettingFaults validate(const KmsSettings& settings);

}  // namespace merlin::render::out::kms
