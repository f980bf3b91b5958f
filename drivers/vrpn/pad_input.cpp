#include "drivers/vrpn/pad_input.h"

#include <algorithm>
#include <string>

#include "drivers/port/axes.h"
#include "drivers/vrpn/numbers.h"

namespace merlin::vrpn {

PadInput::PadInput(const VrpnPadSettings& s)
    : rest_(s.rest),
      full_(s.full),
      dead_zone_(static_cast<float>(s.dead_zone)),
      curve_(static_cast<float>(s.curve)) {
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    sources_[i].axis = static_cast<int>(i);
    if (i < s.axes.size())
      sources_[i] = parseAxisSource(s.axes[i], channelNumber).value_or(AxisSource{});
  }
  for (std::size_t i = 0; i < kButtons; ++i) {
    buttons_[i] = s.buttons.empty() ? static_cast<int>(i) : -1;
    if (i < s.buttons.size()) buttons_[i] = parseNumber(s.buttons[i], kVrpnButtons).value_or(-1);
  }
}

void PadInput::rest() noexcept {
  down_.reset();
  channels_.count = 0;
}

float PadInput::deflection(int channel) const noexcept {
  const auto index = static_cast<std::size_t>(channel);
  if (channel < 0 || index >= channels_.count) return 0;
  const double share = (channels_.value[index] - rest_) / (full_ - rest_);
  return static_cast<float>(std::clamp(share, -1.0, 1.0));
}

float PadInput::deflection(const AxisSource& source) const noexcept {
  const float pushed = deflection(source.axis);
  if (source.minus < 0) return source.reversed ? -pushed : pushed;
  return std::clamp(pushed - deflection(source.minus), -1.0F, 1.0F);
}

std::vector<AxisReading> PadInput::readings() const {
  std::vector<AxisReading> all;
  for (std::size_t channel = 0; channel < channels_.count; ++channel)
    all.push_back({std::to_string(channel), deflection(static_cast<int>(channel))});
  return all;
}

void PadInput::fill(BallSample& sample) const noexcept {
  std::array<float, 6> deflections{};
  std::ranges::transform(sources_, deflections.begin(),
                         [&](const AxisSource& source) { return deflection(source); });
  fillAxes(deflections, dead_zone_, curve_, sample);
  sample.buttons = 0;
  for (std::size_t i = 0; i < kButtons; ++i) {
    if (buttons_[i] >= 0 && down_[static_cast<std::size_t>(buttons_[i])]) sample.buttons |= 1U << i;
  }
}

}  // namespace merlin::vrpn
