#include "render/out/kms/settings.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>

#include <fmt/format.h>

namespace merlin::render::out::kms {
namespace {

constexpr int kLargestSide = 32768;  // [px]
constexpr double kHighestRate = 1000;

// Reads a number from the front of `text` and removes it there.
template <typename T>
bool takeNumber(std::string_view& text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

bool isSide(int side) { return side > 0 && side <= kLargestSide; }

}  // namespace

std::optional<WantedMode> parseMode(const std::string& name) {
  std::string_view text = name;
  WantedMode mode;
  if (!takeNumber(text, mode.width) || !take(text, 'x') || !takeNumber(text, mode.height))
    return std::nullopt;
  if (!isSide(mode.width) || !isSide(mode.height)) return std::nullopt;
  if (text.empty()) return mode;
  if (!take(text, '@') || !takeNumber(text, mode.refresh_hz) || !text.empty()) return std::nullopt;
  if (!(mode.refresh_hz > 0 && mode.refresh_hz <= kHighestRate)) return std::nullopt;
  return mode;
}

SettingFaults validate(const KmsSettings& s) {
  SettingFaults faults;
  if (!s.card.empty() && !s.card.starts_with('/')) {
    faults.push_back({"/card", fmt::format("is \"{}\"; a card is the path of its device file, for "
                                           "example /dev/dri/card0",
                                           s.card)});
  }
  const bool named = std::ranges::all_of(s.connector, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_';
  });
  if (!s.isEvery() && (!named || s.connector.size() > 31)) {
    faults.push_back({"/connector", fmt::format("is \"{}\"; a connector's name is, for example, "
                                                "HDMI-A-1, as in /sys/class/drm; {} is every one",
                                                s.connector, kEveryConnector)});
  }
  if (!s.mode.empty() && !parseMode(s.mode)) {
    faults.push_back({"/mode", fmt::format("is \"{}\"; a mode is WIDTHxHEIGHT or WIDTHxHEIGHT@HZ, "
                                           "for example 1920x1080@60",
                                           s.mode)});
  }
  return faults;
}

}  // namespace merlin::render::out::kms
