// Converts raw values of a CyberGlove to joint angles in slot order, and back. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/cyberglove/protocol.h"
#include "drivers/cyberglove/settings.h"
#include "drivers/port/samples.h"

namespace merlin::cyberglove {

// Fills `angle_rad`, `raw`, `sensors` and `flags` of `sample`; leaves its other fields unchanged. A
// slot that is not in `slots` gets raw 0 and a computed angle: a DIP joint follows from its PIP
// joint [VTI], slot 7 from the rule of the settings, any other slot is 0. Slot 23 is reserved and
// ignored.
void calibrate(const Record& record, const SlotList& slots, const CybergloveSettings& settings,
               GloveSample& sample) noexcept;

// Inverse of calibrate(), for the emulator: returns the raw value of each slot at these angles,
// rounded and clamped to 1..255. A slot with gain 0 gets its offset.
std::array<std::uint8_t, kSlots> rawOf(std::span<const float, kGloveSlots> angle_rad,
                                       const CybergloveSettings& settings) noexcept;

}  // namespace merlin::cyberglove
