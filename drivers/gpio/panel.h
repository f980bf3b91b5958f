// Panel: state machine of the wall's control panel: projectors' power with warm-up, cool-down and
// interlock, A/B video switch, status lamp, debounced button. Pure: time and button are passed in;
// it returns the levels of the output lines.
#pragma once

#include <string_view>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "drivers/gpio/settings.h"
#include "drivers/port/samples.h"

namespace merlin::gpio {

// Levels of the output lines; true is high.
struct Outputs {
  bool projector = false, video = false, lamp = false;
  friend bool operator==(const Outputs&, const Outputs&) = default;
};

// Thread-bound.
class Panel {
 public:
  Panel(const GpioSettings& settings, Timestamp now);

  // Executes one of the commands "projector_on", "projector_off", "video_a", "video_b", "lamp_off",
  // "lamp_slow", "lamp_fast" and "lamp_on". Errors: kInvalidArgument (no such command), kBusy (the
  // projectors cool down or were just switched; the message gives the seconds to wait).
  Result<Ok> execute(std::string_view command, Timestamp now);
  // Switches the warning on or off. While it is on, the lamp blinks fast, whatever the last lamp
  // command was.
  void warn(bool on, Timestamp now);

  // Advances the state to `now`; `pressed` is the level of the button's line. Returns true once for
  // each press, when the button has been down for the debounce time.
  bool step(bool pressed, Timestamp now);

  Outputs outputs(Timestamp now) const;
  // Returns the time until the projectors have warmed up or cooled down; 0 if they do neither.
  Duration phaseLeft(Timestamp now) const;
  GpioSample sample(Timestamp now) const;

  // Returns when the state will next change by itself; Timestamp::max() if never.
  Timestamp nextDue(Timestamp now) const;

 private:
  Result<Ok> switchPower(bool on, Timestamp now);
  Duration powerWait(Timestamp now) const;
  GpioSample::Lamp shownLamp() const { return warns_ ? GpioSample::kLampFast : lamp_; }
  void note(Timestamp now);

  GpioSettings settings_;
  GpioSample::Power power_ = GpioSample::kOff;
  GpioSample::Lamp lamp_ = GpioSample::kLampOff;  // the lamp's state without a warning
  bool warns_ = false;
  bool video_ = false;
  Timestamp switched_, phase_until_;  // projectors: last switched; end of warming or cooling
  Timestamp changed_;
  std::uint32_t counter_ = 0, presses_ = 0;
  bool raw_ = false, down_ = false;  // the button as last read, and debounced
  Timestamp raw_since_;
};

}  // namespace merlin::gpio
