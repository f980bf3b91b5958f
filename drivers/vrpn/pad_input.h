// PadInput: keeps the state of a VRPN device's buttons and channels, and converts it to the buttons
// and axes of a ball. Pure.
#pragma once

#include <array>
#include <bitset>
#include <vector>

#include "drivers/port/axis_source.h"
#include "drivers/port/samples.h"
#include "drivers/port/vrpn_line.h"
#include "drivers/vrpn/pad_settings.h"

namespace merlin::vrpn {

// Allocates nothing after construction.
class PadInput {
 public:
  // REQUIRES: validate() finds no fault in the settings.
  explicit PadInput(const VrpnPadSettings& settings);

  void take(const VrpnButton& button) noexcept { down_[button.button] = button.down; }
  void take(const VrpnButtons& buttons) noexcept { down_ = buttons.down; }
  void take(const VrpnChannels& channels) noexcept { channels_ = channels; }
  void rest() noexcept;  // releases all buttons and pushes

  // Returns the deflection of each channel that the device has sent. Allocates; for calibration.
  std::vector<AxisReading> readings() const;

  // Writes the present state into `sample`: axes, buttons and raw values (fillAxes() of
  // drivers/port/axes.h). A channel that the device has not sent is at rest.
  void fill(BallSample& sample) const noexcept;

 private:
  static constexpr std::size_t kButtons = 12;

  float deflection(int channel) const noexcept;
  float deflection(const AxisSource& source) const noexcept;

  AxisSources sources_{};
  std::array<int, kButtons> buttons_{};  // the server's numbers; -1: none
  double rest_, full_;
  float dead_zone_, curve_;
  std::bitset<kVrpnButtons> down_;
  VrpnChannels channels_;
};

}  // namespace merlin::vrpn
