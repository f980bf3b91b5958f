#include "daemon/actions/input.h"

#include <charconv>

namespace merlin::actions {
namespace {

constexpr unsigned kMostButtons = 12;

std::optional<std::uint32_t> buttonBit(std::string_view number) {
  unsigned button = 0;
  const char* const end = number.data() + number.size();
  const auto parsed = std::from_chars(number.data(), end, button);
  if (parsed.ec != std::errc() || parsed.ptr != end || button < 1 || button > kMostButtons)
    return std::nullopt;
  return 1U << (button - 1);
}

}  // namespace

shm::ActionSource Input::source() const {
  switch (kind) {
    case Kind::kBallButton: return shm::kBallActions;
    case Kind::kPanelButton: return shm::kPanelActions;
    case Kind::kPosture:
    case Kind::kWristSwitch: break;
  }
  return shm::kGloveActions;
}

std::optional<Input> parseInput(std::string_view name) {
  constexpr std::string_view kButton = "ball.button.", kPosture = "posture.";
  Input input;
  if (name == "glove.switch") {
    input.kind = Input::Kind::kWristSwitch;
    return input;
  }
  if (name == "panel.button") {
    input.kind = Input::Kind::kPanelButton;
    return input;
  }
  if (name.starts_with(kPosture) && name.size() > kPosture.size()) {
    input.kind = Input::Kind::kPosture;
    input.posture = name.substr(kPosture.size());
    return input;
  }
  if (!name.starts_with(kButton)) return std::nullopt;
  const auto bit = buttonBit(name.substr(kButton.size()));
  if (!bit) return std::nullopt;
  input.button = *bit;
  return input;
}

}  // namespace merlin::actions
