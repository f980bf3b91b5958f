#include "drivers/hand/people.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace merlin::hand {
namespace {

constexpr std::size_t kIndexAbduction = 7, kPalm = 20, kWristPitch = 21, kSlotsOfAFinger = 4;
constexpr double kFingerShare = 0.7;  // share of the variance that a finger's joints have in common

float span(std::size_t slot) { return kJointSpans[slot].high_rad - kJointSpans[slot].low_rad; }

bool isWrist(std::size_t slot) { return slot >= kWristPitch; }

// FNV-1a hash: a habit depends on the posture's name, not on its place in a list.
std::uint64_t hash(std::string_view text) {
  std::uint64_t h = 0xCBF29CE484222325;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  return h;
}

// Adds a normally distributed deviation to each joint but the wrist's: `sigma` times the joint's
// range. The flexions of a finger are correlated; the abductions (slots 3, 7, 11, ...) and the palm
// arch are independent.
void stray(Angles& joints, double sigma, Random& random) {
  double finger = 0;
  for (std::size_t slot = 0; slot <= kPalm; ++slot) {
    if (slot % kSlotsOfAFinger == 0) finger = random.normal();
    const bool alone = slot % kSlotsOfAFinger == 3 || slot == kPalm;
    const double own = random.normal();
    const double mixed =
        alone ? own : std::sqrt(kFingerShare) * finger + std::sqrt(1 - kFingerShare) * own;
    joints[slot] += static_cast<float>(sigma * static_cast<double>(span(slot)) * mixed);
  }
}

}  // namespace

const std::array<JointSpan, kGloveSlots> kJointSpans = {{
    {-0.1F, 0.6F, 0.4F / 24},   {-0.2F, 1.1F, 0.9F / 71},  {-0.2F, 1.2F, 0.8F / 40},
    {0.0F, 0.7F, 0.3F / 137},   {-0.3F, 1.7F, 1.5F / 68},  {-0.1F, 1.9F, 1.7F / 129},
    {-0.1F, 1.5F, 1.3F / 41},   {-0.3F, 0.3F, 0.4F / 254}, {-0.3F, 1.7F, 1.5F / 68},
    {-0.1F, 1.9F, 1.7F / 137},  {-0.1F, 1.5F, 1.3F / 36},  {-0.3F, 0.4F, 0.4F / 51},
    {-0.3F, 1.7F, 1.5F / 55},   {-0.1F, 1.9F, 1.7F / 144}, {-0.1F, 1.5F, 1.3F / 49},
    {-0.1F, 0.45F, 0.27F / 48}, {-0.3F, 1.7F, 1.5F / 71},  {-0.1F, 1.9F, 1.7F / 163},
    {-0.1F, 1.5F, 1.3F / 44},   {-0.2F, 0.6F, 0.7F / 84},  {-0.1F, 0.6F, 0.5F / 84},
    {-0.9F, 1.1F, 1.6F / 108},  {-0.6F, 0.5F, 0.8F / 118},
}};

Person::Person(std::uint64_t seed, const PeopleSettings& settings)
    : settings_(settings), seed_(seed) {
  bend_.fill(1.0F);
  if (seed == 0) return;
  Random random(seed * 0x9E3779B97F4A7C15 + 1);
  const double size = settings.size * random.normal();
  for (std::size_t slot = 0; slot < kGloveSlots; ++slot) {
    bend_[slot] = static_cast<float>(1 + size + settings.joint * random.normal());
    fit_rad_[slot] = static_cast<float>(settings.fit * random.normal()) * span(slot);
    for (float& leak : leak_[slot])
      leak = static_cast<float>(settings.cross_talk * random.normal());
  }
}

Angles Person::pose(const Shape& shape) const {
  Angles joints = shape.angle_rad;
  if (seed_ == 0) return joints;
  Random random(seed_ ^ hash(shape.name));
  stray(joints, settings_.habit, random);
  return joints;
}

Angles Person::take(const Shape& shape, Random& random) const {
  Angles joints = pose(shape);
  stray(joints, settings_.take, random);
  for (std::size_t slot = kWristPitch; slot < kGloveSlots; ++slot)
    joints[slot] += static_cast<float>(settings_.wrist * random.normal()) * span(slot);
  return joints;
}

Angles Person::sense(const Angles& joints, Random& random) const {
  Angles true_rad = joints;
  for (std::size_t slot = 0; slot < kGloveSlots; ++slot) {
    const auto [low, high, count] = kJointSpans[slot];
    true_rad[slot] *= bend_[slot];
    true_rad[slot] += static_cast<float>(settings_.tremor * random.normal()) * (high - low);
    true_rad[slot] = std::clamp(true_rad[slot], low, high);
  }
  Angles sensed{};
  for (std::size_t slot = 0; slot < kGloveSlots; ++slot) {
    float a = true_rad[slot] + fit_rad_[slot];
    if (slot > 0 && !isWrist(slot)) a += leak_[slot][0] * true_rad[slot - 1];
    if (slot < kPalm) a += leak_[slot][1] * true_rad[slot + 1];
    const float count = kJointSpans[slot].rad_per_count;
    const auto noise = static_cast<float>(settings_.sensor_counts * random.normal());
    sensed[slot] = std::round(a / count + noise) * count;
  }
  sensed[kIndexAbduction] = 0;
  return sensed;
}

}  // namespace merlin::hand
