// Alignment and boresight of a station, from where it is held, one place after the other. Pure.
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

// Frame in which samples of one station are given; as in FastrakSettings.
struct StationFrame {
  std::array<float, 9> alignment_cm = FastrakSettings::kAligned;
  std::array<float, 4> boresight_wxyz = FastrakSettings::kAhead;
};

// Where a station was while it was held, in the transmitter's frame: the mean of the samples, and
// how far the one furthest from it was.
struct HeldPose {
  int samples = 0;
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_wxyz{};
  double spread_m = 0, spread_rad = 0;
};

// Steps of a guided alignment, in this order: the first three are the alignment's, the last is the
// boresight's.
enum AlignmentStep : std::size_t { kOrigin, kOnX, kOnY, kAhead };
std::span<const GuidedStep> alignmentSteps();

// The sample as it were without alignment and boresight: in the transmitter's frame.
TrackerSample inTransmitterFrame(const TrackerSample& sample, const StationFrame& frame) noexcept;

class GuidedAlignment {
 public:
  // `present`: what the samples to come are given in.
  explicit GuidedAlignment(const StationFrame& present) : present_(present) {}

  void begin(std::size_t step);  // what comes from now on belongs to it; again: anew
  void add(const TrackerSample& sample);

  // The step under way. Errors: kTimeout (fewer than three samples that the unit had no complaint
  // of), kMalformed (it moved; too near to the origin; the three places nearly on one line).
  Result<HeldPose> end();

  // Solves from the steps that ended well. Without the places, the present alignment stays; without
  // the boresight, the present straight ahead stays, expressed in the new frame. REQUIRES: all
  // three places, or none of them.
  StationFrame solve() const;

 private:
  Result<Ok> checkPlace(const HeldPose& held) const;

  StationFrame present_;
  std::size_t step_ = 0;
  std::vector<TrackerSample> samples_;  // of the step under way, in the transmitter's frame
  char error_ = ' ';                    // that the unit had last, in this step
  std::array<std::optional<HeldPose>, 4> held_;
};

}  // namespace merlin::fastrak
