// Settings of a CyberGlove.
#pragma once

#include <array>
#include <cstddef>

#include "drivers/port/port_address.h"

namespace merlin {

class SettingsVisitor;

inline constexpr int kCybergloveBaud = 38400;  // factory setting of its line

// Value of slot 7, the abduction of the index finger, which no known glove measures.
enum class Slot7Rule {
  kZero,     // 0
  kNeutral,  // angle for the middle of the raw range, 128, by the slot's offset and gain
  kDerived,  // mean of the abductions on either side of the index finger, slots 3 and 11
  kSwitch,   // 1 while the wrist switch is on, else 0
};

// Linear calibration of a sensor by two points: the joint's angle is `rad_a` at the raw value
// `raw_a`, and `rad_b` at `raw_b`.
struct GloveSpan {
  float raw_a, rad_a, raw_b, rad_b;

  constexpr float gain() const { return (rad_b - rad_a) / (raw_b - raw_a); }
  constexpr float offset() const { return raw_a - rad_a / gain(); }
};

// The default calibration, in slot order. Source: README.md, "Calibration".
inline constexpr std::array<GloveSpan, 23> kDefaultGloveSpans = {{
    {74, 0.0F, 98, 0.4F},     // 0 thumb roll
    {111, 0.0F, 182, 0.9F},   // 1 thumb MCP
    {90, 0.0F, 130, 0.8F},    // 2 thumb IP
    {79, 0.2F, 216, 0.5F},    // 3 thumb abduction
    {117, 0.0F, 185, 1.5F},   // 4 index MCP
    {69, 0.0F, 198, 1.7F},    // 5 index PIP
    {66, 0.0F, 107, 1.3F},    // 6 index DIP
    {1, -0.2F, 255, 0.2F},    // 7 index abduction: assumed
    {93, 0.0F, 161, 1.5F},    // 8 middle MCP
    {62, 0.0F, 199, 1.7F},    // 9 middle PIP
    {93, 0.0F, 129, 1.3F},    // 10 middle DIP
    {121, -0.2F, 172, 0.2F},  // 11 middle-index abduction
    {108, 0.0F, 163, 1.5F},   // 12 ring MCP
    {58, 0.0F, 202, 1.7F},    // 13 ring PIP
    {73, 0.0F, 122, 1.3F},    // 14 ring DIP
    {86, 0.0F, 134, 0.27F},   // 15 ring-middle abduction
    {101, 0.0F, 172, 1.5F},   // 16 pinky MCP
    {46, 0.0F, 209, 1.7F},    // 17 pinky PIP
    {91, 0.0F, 135, 1.3F},    // 18 pinky DIP
    {55, -0.2F, 139, 0.5F},   // 19 pinky-ring abduction
    {60, 0.0F, 144, 0.5F},    // 20 palm arch: angles assumed
    {73, 0.9F, 181, -0.7F},   // 21 wrist pitch
    {46, 0.3F, 164, -0.5F},   // 22 wrist yaw
}};

struct CybergloveSettings {
  // angle_rad = (raw - offset) * gain, by slot; a sensor that is mounted the other way round has a
  // negative gain.
  std::array<float, 23> offset = [] {
    std::array<float, 23> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = kDefaultGloveSpans[i].offset();
    return all;
  }();
  std::array<float, 23> gain = [] {
    std::array<float, 23> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = kDefaultGloveSpans[i].gain();
    return all;
  }();
  Slot7Rule slot7 = Slot7Rule::kZero;
  double rate_hz = 100;  // requested records per second, 1..150
  enum class Dialogue { kBinary, kText };
  Dialogue dialogue = Dialogue::kBinary;
  bool filter = true;  // the low-pass filter of the interface unit
  enum class Light { kSwitch, kOff, kOn };
  Light light = Light::kSwitch;  // wrist light: shows the wrist switch, or is always off or on
  bool time_stamps = false;      // requests time stamps, by which lost records are counted
};

// Returns a fault if the line cannot carry `rate_hz` records per second. Its JSON pointer is
// "/rate_hz".
SettingFaults validate(const CybergloveSettings& glove, const LineSettings& line);

// Calls `visitor` for every setting, in the order in which MERLIN writes them to a file.
void describe(CybergloveSettings& glove, SettingsVisitor& visitor);

}  // namespace merlin
