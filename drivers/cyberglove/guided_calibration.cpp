#include "drivers/cyberglove/guided_calibration.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace merlin::cyberglove {
namespace {

constexpr GuidedStep kPoses[] = {
    {"flat", "hand flat on the table, fingers together, thumb beside them, wrist straight"},
    {"fist", "a tight fist, thumb outside"},
    {"spread", "fingers and thumb spread as far as they go, hand flat"},
    {"thumb", "thumb across the palm, bent, to the root of the little finger"},
    {"cup", "palm cupped as if to hold water, base of the little finger towards base of the thumb"},
    {"wrist up", "hand bent back as far as it goes"},
    {"wrist aside", "hand bent towards the thumb as far as it goes"},
};
enum Pose : std::size_t { kFlat, kFist, kSpread, kThumb, kCup, kUp, kAside };

// The second pose by which a sensor is calibrated, and its joint's angle there; the first is
// "flat", with 0 rad. The angles are those of an adult hand, as in the default calibration.
struct Target {
  Pose pose;
  float angle_rad;
};
constexpr Target kTargets[kGloveSlots] = {
    {kThumb, 0.4F}, {kThumb, 0.9F}, {kThumb, 0.8F}, {kSpread, 0.5F},  // thumb
    {kFist, 1.5F},  {kFist, 1.7F},  {kFist, 1.3F},  {kFlat, 0},       // index; slot 7 has no sensor
    {kFist, 1.5F},  {kFist, 1.7F},  {kFist, 1.3F},  {kSpread, 0.2F},  // middle
    {kFist, 1.5F},  {kFist, 1.7F},  {kFist, 1.3F},  {kSpread, 0.27F},  // ring
    {kFist, 1.5F},  {kFist, 1.7F},  {kFist, 1.3F},  {kSpread, 0.5F},   // pinky
    {kCup, 0.5F},   {kUp, 0.7F},    {kAside, 0.3F}};
constexpr double kLeastSpan = 8;  // raw counts; a sensor's noise is one or two

}  // namespace

std::span<const GuidedStep> guidedPoses() { return kPoses; }

void GuidedCalibration::begin(std::size_t pose) {
  pose_ = pose;
  poses_[pose] = {};
}

void GuidedCalibration::add(const GloveSample& sample) {
  Pose& pose = poses_[pose_];
  ++pose.count;
  for (std::size_t i = 0; i < kGloveSlots; ++i) {
    const std::uint8_t raw = sample.raw[i];
    if (raw == 0) continue;
    pose.sum[i] += raw;
    low_[i] = low_[i] == 0 ? raw : std::min(low_[i], raw);
    high_[i] = std::max(high_[i], raw);
  }
}

Result<CybergloveSettings> GuidedCalibration::solve(const CybergloveSettings& settings) const {
  CybergloveSettings solved = settings;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (poses_[i].count == 0)
      return Error{Errc::kMalformed,
                   fmt::format("no record came in the pose \"{}\"", kPoses[i].name)};
  }
  std::string still;
  for (std::size_t i = 0; i < kGloveSlots; ++i) {
    const Target& target = kTargets[i];
    if (high_[i] == 0 || target.pose == kFlat) continue;
    const double flat = poses_[kFlat].sum[i] / poses_[kFlat].count;
    const double bent = poses_[target.pose].sum[i] / poses_[target.pose].count;
    if (std::abs(bent - flat) < kLeastSpan) {
      still += fmt::format("{}{} by {:.0f} in \"{}\"", still.empty() ? "" : ", ", i,
                           std::abs(bent - flat), kPoses[target.pose].name);
      continue;
    }
    solved.gain[i] = static_cast<float>(double{target.angle_rad} / (bent - flat));
    solved.offset[i] = static_cast<float>(flat);
  }
  if (still.empty()) return solved;
  return Error{
      Errc::kMalformed,
      fmt::format("sensors hardly moved (slot, raw counts; {:.0f} are needed): {}; were the "
                  "poses held, and is the glove's plug in?",
                  kLeastSpan, still)};
}

}  // namespace merlin::cyberglove
