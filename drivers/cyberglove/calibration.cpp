#include "drivers/cyberglove/calibration.h"

#include <algorithm>
#include <cmath>

namespace merlin::cyberglove {
namespace {

constexpr std::size_t kThumbAbduction = 3;
constexpr std::size_t kIndexAbduction = 7;
constexpr std::size_t kMiddleIndexAbduction = 11;
constexpr std::size_t kDip[] = {6, 10, 14, 18};  // the slot before a DIP is the finger's PIP

float angle(float raw, std::size_t slot, const CybergloveSettings& settings) noexcept {
  return (raw - settings.offset[slot]) * settings.gain[slot];
}

float slot7(const GloveSample& sample, const CybergloveSettings& settings) noexcept {
  switch (settings.slot7) {
    case Slot7Rule::kZero: break;
    case Slot7Rule::kNeutral: return angle(128, kIndexAbduction, settings);
    case Slot7Rule::kDerived:
      return (sample.angle_rad[kThumbAbduction] + sample.angle_rad[kMiddleIndexAbduction]) / 2;
    case Slot7Rule::kSwitch: return sample.flags & GloveSample::kWristSwitch ? 1.0F : 0.0F;
  }
  return 0;
}

}  // namespace

void calibrate(const Record& record, const SlotList& slots, const CybergloveSettings& settings,
               GloveSample& sample) noexcept {
  std::fill(std::begin(sample.raw), std::end(sample.raw), std::uint8_t{0});
  std::fill(std::begin(sample.angle_rad), std::end(sample.angle_rad), 0.0F);
  sample.flags = record.status & (Record::kPlugged | Record::kWristSwitch | Record::kLight);
  sample.sensors = 0;
  for (std::size_t i = 0; i < slots.count; ++i) {
    const std::size_t slot = slots.slot[i];
    if (slot >= kGloveSlots) continue;
    sample.raw[slot] = record.values[i];
    sample.angle_rad[slot] = angle(record.values[i], slot, settings);
    ++sample.sensors;
  }
  for (const std::size_t dip : kDip) {
    const float pip = sample.angle_rad[dip - 1];
    if (sample.raw[dip] == 0) sample.angle_rad[dip] = 0.32F * pip * pip + 0.17F * pip;
  }
  if (sample.raw[kIndexAbduction] == 0) {
    sample.angle_rad[kIndexAbduction] = slot7(sample, settings);
  }
}

std::array<std::uint8_t, kSlots> rawOf(std::span<const float, kGloveSlots> angle_rad,
                                       const CybergloveSettings& settings) noexcept {
  std::array<std::uint8_t, kSlots> raw{};
  raw.fill(1);
  for (std::size_t slot = 0; slot < kGloveSlots; ++slot) {
    const float gain = settings.gain[slot];
    const float exact = settings.offset[slot] + (gain == 0 ? 0.0F : angle_rad[slot] / gain);
    raw[slot] = static_cast<std::uint8_t>(std::lround(std::clamp(exact, 1.0F, 255.0F)));
  }
  return raw;
}

}  // namespace merlin::cyberglove
