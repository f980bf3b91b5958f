// InputDevice: the axes and keys of an input device of the kernel, their state, and its conversion
// to a ball's axes and buttons. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "drivers/evdev/axis_names.h"
#include "drivers/evdev/settings.h"
#include "drivers/port/axis_source.h"
#include "drivers/port/evdev_line.h"
#include "drivers/port/samples.h"

namespace merlin::evdev {

class InputDevice {
 public:
  // Takes one record of the description, or of the state that follows it.
  void describe(const EvdevRecord& record);
  // Takes one record of an event, which arrived at `at`; an event of an axis or key that was not
  // described is ignored. Allocates nothing.
  void take(const EvdevRecord& record, Timestamp at) noexcept;

  // Chooses axes and buttons by the settings, or by the kind of device; to be called once the
  // description is complete. Returns a sentence that lists what the settings name and the device
  // lacks; empty if it lacks nothing. The other settings take effect all the same.
  std::string choose(const EvdevSettings& settings);

  // Writes the present state into `sample`: axes, raw values (fillAxes() of drivers/port/axes.h),
  // buttons and keys. Allocates nothing.
  void fill(BallSample& sample) const noexcept;
  // Sets each relative axis to rest if no event of it has arrived since `since`: such an axis
  // reports motion, but not its end. Returns whether any of them was not at rest before.
  bool restRelative(Timestamp since) noexcept;

  const std::string& name() const noexcept { return name_; }
  std::size_t axes() const noexcept;
  std::size_t keys() const noexcept { return keys_.size(); }
  // Return the names of all axes, or of all keys, as used in the settings and in the order of the
  // kernel's numbers. An axis that settings cannot name is left out.
  std::vector<std::string> axisNames() const;
  std::vector<std::string> keyNames() const;
  // Returns the present deflections of the axes in axisNames(). Allocates; for calibration.
  std::vector<AxisReading> readings() const;
  // Returns the axes that choose() selected.
  const AxisSources& sources() const noexcept { return sources_; }
  // Describes the axes and buttons that choose() selected, for a person: "axes x, rz-z, y, ry, rx,
  // -hat0x; buttons south, east".
  std::string chosen() const;

 private:
  struct Axis {
    bool there = false, relative = false;
    std::int32_t value = 0, low = 0, high = 0;
    Timestamp told{};  // when its last event arrived
  };
  struct Key {
    std::uint16_t code = 0;
    std::string name;
    bool pressed = false;
  };
  static constexpr std::size_t kAxes = 0x18;  // the axes in kAxisForms have lower numbers
  static constexpr std::size_t kButtons = 12;

  Axis* axis(std::uint16_t code) noexcept;
  bool has(int code) const noexcept;
  bool hasKey(std::uint16_t code) const noexcept;
  AxisSources usualSources() const;
  std::vector<std::string> chooseAxes(const std::vector<std::string>& names);
  std::vector<std::string> chooseButtons(const std::vector<std::string>& names);
  void chooseUsualButtons();
  float deflection(const AxisSource& source) const noexcept;
  float centred(int code) const noexcept;
  float oneSided(int code) const noexcept;

  std::string name_;
  std::array<Axis, kAxes> axes_{};
  std::vector<Key> keys_;  // ascending by number
  AxisSources sources_{};
  std::array<std::size_t, kButtons> buttons_{};  // 1 + index into keys_; 0: none
  float dead_zone_ = 0, curve_ = 1;
};

}  // namespace merlin::evdev
