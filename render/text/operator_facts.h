// OperatorFacts: the facts about the wall that the operator's tile shows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "render/text/frame_chart.h"

namespace merlin::render::text {

// The colour of a device's dot.
enum class DeviceLight { kGood, kWaiting, kBad };

struct DeviceFact {
  std::string name;   // "glove"
  std::string state;  // a word: "ok"
  DeviceLight light = DeviceLight::kBad;

  bool operator==(const DeviceFact&) const = default;
};

struct MessageFact {
  std::string text;
  float strength = 1;  // 1: new; less while it fades

  bool operator==(const MessageFact&) const = default;
};

struct OperatorFacts {
  double rate_asked_hz = 0, rate_held_hz = 0;
  double rate_now_hz = 0;   // less than asked if the wall has lowered it
  double late_percent = 0;  // late frames in the last minute
  FrameChart::Columns chart{};

  // Cost of the detail that is shown, and of full detail, in cost_unit.
  std::uint32_t cost = 0, full_cost = 0;
  std::uint32_t budget = 0;     // budget of frames while something moves, in cost_unit
  bool budget_by_hand = false;  // the budget was set by a person
  bool full_detail = false;
  std::string cost_unit;  // "triangles"

  std::string content, slide;         // names; no slide: empty
  std::string mode;                   // what the ball moves
  std::string posture;                // empty: none
  std::vector<DeviceFact> devices;    // those that are configured
  bool devices_missing = false;       // devices are configured, but nothing is known about them
  std::vector<MessageFact> messages;  // the newest first

  bool operator==(const OperatorFacts&) const = default;
};

// Port (an interface): supplies the facts that the operator's tile shows.
class OperatorSource {
 public:
  virtual ~OperatorSource() = default;

  // Called on the wall's thread, at most ten times a second; never waits.
  virtual OperatorFacts read(Timestamp now) = 0;
};

}  // namespace merlin::render::text
