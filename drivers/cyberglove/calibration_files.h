// Converts calibrations that other programs wrote to MERLIN's offsets and gains. Pure.
//
// Known formats, recognised by their content; sources: README.md beside this file.
//   vendor's .cal   "GLOVE CALIBRATION", 24 lines "joint offset gain gesture" in slot order
//   asr_cyberglove  22 lines "angle:raw angle:raw" [rad], in an order of its own, flexion negative
//   Shadow XML      <Joint name="G_..."><calib raw_value="0..1" calibrated_value="degrees"/>
//   Shadow YAML     ["G_...", [[raw 0..1, degrees], ...]]
//   VESS            23 lines "idle min max", slots 0 to 22; each slot has a fixed range of angles
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "drivers/cyberglove/settings.h"

namespace merlin::cyberglove {

struct ImportedCalibration {
  const char* format = "";
  std::array<bool, 23> given{};  // slots that the file has; the others are not changed
  std::array<float, 23> offset{}, gain{};
};

// Errors: kMalformed, naming the line or the joint: unknown format, an invalid number, two points
// with the same raw value, a minimum that is not below its maximum.
Result<ImportedCalibration> importCalibration(std::string_view text);

}  // namespace merlin::cyberglove
