// Calibrations that other programs wrote, as MERLIN's offsets and gains. Pure.
//
// Known formats, told by their content; sources: README.md beside this file.
//   vendor's .cal   "GLOVE CALIBRATION", 24 lines "joint offset gain gesture" in slot order
//   asr_cyberglove  22 lines "angle:raw angle:raw" [rad], in its own order, flexion negative
//   Shadow XML      <Joint name="G_..."><calib raw_value=".." calibrated_value=".."/>, 0..1,
//   degrees Shadow YAML     ["G_...", [[raw, degrees], ...]] VESS            23 lines "idle min
//   max", slots 0 to 22, over fixed ranges
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "drivers/cyberglove/settings.h"

namespace merlin::cyberglove {

struct ImportedCalibration {
  const char* format = "";
  std::array<bool, 23> given{};  // slots that the file says something of; the others keep theirs
  std::array<float, 23> offset{}, gain{};
};

// Errors: kMalformed, naming the line or the joint: no known format, a number that is none, two
// points at one raw value, a minimum above its maximum.
Result<ImportedCalibration> importCalibration(std::string_view text);

}  // namespace merlin::cyberglove
