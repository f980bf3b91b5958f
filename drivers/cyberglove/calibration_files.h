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
  std::array<bool, 23> given{};  // slots that the file contains
  std::array<float, 23> offset{}, gain{};
};

// Recognises the format of a calibration file and returns its offsets and gains. Errors: kMalformed
// if the format is unknown, a number is invalid, two points have the same raw value, or a minimum
// is not below its maximum; the message names the line or the joint.
Result<ImportedCalibration> importCalibration(std::string_view text);

}  // namespace merlin::cyberglove
