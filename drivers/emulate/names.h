// Names of the drivers whose device can be emulated. They are not in emulator.h because merlind
// does not contain the emulators: it starts `merlin emulate`.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace merlin::emulate {

inline constexpr std::array<std::string_view, 3> kEmulated = {"cyberglove", "fastrak", "spaceball"};

constexpr bool isEmulated(std::string_view driver) {
  return std::find(kEmulated.begin(), kEmulated.end(), driver) != kEmulated.end();
}

}  // namespace merlin::emulate
