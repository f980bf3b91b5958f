// Determines alignment and boresight of a station from places at which a person holds it. Pure.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "daemon/base/result.h"
#include "drivers/fastrak/settings.h"
#include "drivers/port/guided_step.h"
#include "drivers/port/samples.h"

namespace merlin::fastrak {

// Frame in which the samples of one station are given, described as in FastrakSettings.
struct StationFrame {
  std::array<float, 9> alignment_cm = FastrakSettings::kAligned;
  std::array<float, 4> boresight_wxyz = FastrakSettings::kAhead;
};

// Pose of a station while it was held, in the transmitter's frame: the mean of its samples, and the
// largest deviation of a sample from the mean.
struct HeldPose {
  int samples = 0;
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_wxyz{};
  double spread_m = 0, spread_rad = 0;
};

// Steps of a guided alignment, in this order: the first three determine the alignment, the last the
// boresight.
enum AlignmentStep : std::size_t { kOrigin, kOnX, kOnY, kAhead };
std::span<const GuidedStep> alignmentSteps();

// Undoes alignment and boresight: returns the sample in the transmitter's frame.
TrackerSample inTransmitterFrame(const TrackerSample& sample, const StationFrame& frame) noexcept;

class GuidedAlignment {
 public:
  // `present`: the frame of the samples that are passed to add().
  explicit GuidedAlignment(const StationFrame& present) : present_(present) {}

  void begin(std::size_t step);  // starts or restarts a step; later samples belong to it
  void add(const TrackerSample& sample);

  // Ends the current step. Errors: kTimeout (fewer than three samples without an error of the
  // unit), kMalformed (the station moved; it is too near to the origin; the three places are nearly
  // on one line).
  Result<HeldPose> end();

  // Returns the frame that follows from the steps that ended without an error. Without the places,
  // the present alignment is kept; without the last step, the orientation that counts as straight
  // ahead is kept, expressed in the new frame. REQUIRES: all three places, or none of them.
  StationFrame solve() const;

 private:
  Result<Ok> checkPlace(const HeldPose& held) const;

  StationFrame present_;
  std::size_t step_ = 0;
  std::vector<TrackerSample> samples_;  // of the current step, in the transmitter's frame
  char error_ = ' ';                    // last error of the unit in the current step
  std::array<std::optional<HeldPose>, 4> held_;
};

}  // namespace merlin::fastrak
