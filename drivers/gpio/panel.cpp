#include "drivers/gpio/panel.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace merlin::gpio {
namespace {

constexpr Duration kSlow = std::chrono::seconds(1);  // half periods of the blinking lamp
constexpr Duration kFast = std::chrono::milliseconds(125);

Duration halfPeriod(GpioSample::Lamp lamp) { return lamp == GpioSample::kLampSlow ? kSlow : kFast; }

bool blinks(GpioSample::Lamp lamp) {
  return lamp == GpioSample::kLampSlow || lamp == GpioSample::kLampFast;
}

}  // namespace

// The earlier state of the projectors is unknown. The panel assumes that they are off, and starts
// the interlock time now.
Panel::Panel(const GpioSettings& settings, Timestamp now)
    : settings_(settings), switched_(now), phase_until_(now), changed_(now), raw_since_(now) {}

Result<Ok> Panel::execute(std::string_view command, Timestamp now) {
  constexpr std::pair<std::string_view, GpioSample::Lamp> kLamps[] = {
      {"lamp_off", GpioSample::kLampOff},
      {"lamp_slow", GpioSample::kLampSlow},
      {"lamp_fast", GpioSample::kLampFast},
      {"lamp_on", GpioSample::kLampOn}};
  if (command == "projector_on") return switchPower(true, now);
  if (command == "projector_off") return switchPower(false, now);
  if (command == "video_a" || command == "video_b") {
    video_ = command == "video_b";
    note(now);
    return Ok{};
  }
  for (const auto& [name, lamp] : kLamps) {
    if (command != name) continue;
    lamp_ = lamp;
    note(now);
    return Ok{};
  }
  return Error{Errc::kInvalidArgument,
               fmt::format("\"{}\" is not a command of the panel", command)};
}

void Panel::warn(bool on, Timestamp now) {
  if (std::exchange(warns_, on) != on) note(now);
}

// A projector lamp that is switched on while it cools down can burst; frequent switching wears out
// the relays.
Result<Ok> Panel::switchPower(bool on, Timestamp now) {
  step(raw_, now);
  const bool is_on = power_ == GpioSample::kWarming || power_ == GpioSample::kOn;
  if (is_on == on) return Ok{};
  if (const Duration wait = powerWait(now); wait > Duration::zero()) {
    return Error{Errc::kBusy,
                 fmt::format("the projectors {}: wait {:.0f} s",
                             power_ == GpioSample::kCooling ? "cool down" : "were just switched",
                             toSeconds(wait))};
  }
  power_ = on ? GpioSample::kWarming : GpioSample::kCooling;
  switched_ = now;
  phase_until_ = now + fromSeconds(on ? settings_.warm_up_s : settings_.cool_down_s);
  note(now);
  return Ok{};
}

Duration Panel::powerWait(Timestamp now) const {
  Timestamp free = switched_ + fromSeconds(settings_.interlock_s);
  if (power_ == GpioSample::kCooling) free = std::max(free, phase_until_);
  return std::max<Duration>(free - now, Duration::zero());
}

bool Panel::step(bool pressed, Timestamp now) {
  if (now >= phase_until_ && power_ == GpioSample::kWarming) {
    power_ = GpioSample::kOn;
    note(now);
  }
  if (now >= phase_until_ && power_ == GpioSample::kCooling) {
    power_ = GpioSample::kOff;
    note(now);
  }
  if (pressed != raw_) {
    raw_ = pressed;
    raw_since_ = now;
  }
  if (raw_ == down_ || now - raw_since_ < fromSeconds(settings_.debounce_s)) return false;
  down_ = raw_;
  if (!down_) return false;
  ++presses_;
  note(now);
  return true;
}

Outputs Panel::outputs(Timestamp now) const {
  Outputs o;
  o.projector = power_ == GpioSample::kWarming || power_ == GpioSample::kOn;
  o.video = video_;
  const GpioSample::Lamp lamp = shownLamp();
  o.lamp = lamp == GpioSample::kLampOn ||
           (blinks(lamp) && (now.time_since_epoch() / halfPeriod(lamp)) % 2 == 0);
  return o;
}

Duration Panel::phaseLeft(Timestamp now) const {
  const bool changes = power_ == GpioSample::kWarming || power_ == GpioSample::kCooling;
  return changes ? std::max<Duration>(phase_until_ - now, Duration::zero()) : Duration::zero();
}

GpioSample Panel::sample(Timestamp now) const {
  GpioSample s{};
  s.changed_ns = toNanoseconds(changed_);
  s.counter = counter_;
  s.power = power_;
  s.video = video_ ? 1 : 0;
  s.lamp = shownLamp();
  s.presses = presses_;
  s.wait_s = static_cast<float>(toSeconds(powerWait(now)));
  return s;
}

Timestamp Panel::nextDue(Timestamp now) const {
  Timestamp due = Timestamp::max();
  if (power_ == GpioSample::kWarming || power_ == GpioSample::kCooling) due = phase_until_;
  if (raw_ != down_) due = std::min(due, raw_since_ + fromSeconds(settings_.debounce_s));
  if (blinks(shownLamp())) {
    const Duration half = halfPeriod(shownLamp());
    due = std::min(due, Timestamp((now.time_since_epoch() / half + 1) * half));
  }
  return due;
}

void Panel::note(Timestamp now) {
  changed_ = now;
  ++counter_;
}

}  // namespace merlin::gpio
