#include "drivers/port/axis_source.h"

#include <map>
#include <tuple>

#include <fmt/format.h>

namespace merlin {

std::optional<AxisSource> parseAxisSource(std::string_view text, const AxisNumber& number) {
  if (text == "none") return AxisSource{};
  AxisSource source;
  source.reversed = text.starts_with('-');
  if (source.reversed) text.remove_prefix(1);
  const auto between = text.find('-');
  const auto first = number(text.substr(0, between));
  if (!first) return std::nullopt;
  source.axis = *first;
  if (between == std::string_view::npos) return source;
  const auto second = number(text.substr(between + 1));
  if (!second || source.reversed || *second == *first) return std::nullopt;
  source.minus = *second;
  return source;
}

void checkAxisSources(const std::vector<std::string>& texts, const AxisNumber& number,
                      const std::string& pointer, const char* forms, SettingFaults& faults) {
  constexpr std::size_t kAxes = std::tuple_size_v<AxisSources>;
  if (!texts.empty() && texts.size() != kAxes) {
    faults.push_back({pointer, fmt::format("has {} texts; it needs {}, for x, y, z and the "
                                           "rotations about them, or none",
                                           texts.size(), kAxes)});
  }
  std::map<int, std::size_t> used;  // axes of the device, and the first text that names each
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string at = fmt::format("{}/{}", pointer, i);
    const auto source = parseAxisSource(texts[i], number);
    if (!source) {
      faults.push_back({at, fmt::format("is \"{}\"; allowed are {}", texts[i], forms)});
      continue;
    }
    for (const int axis : {source->axis, source->minus}) {
      const auto [first, is_new] = used.emplace(axis, i);
      if (axis < 0 || is_new) continue;
      faults.push_back({at, fmt::format("is \"{}\", and \"{}\" before it uses that axis already; "
                                        "an axis moves one thing",
                                        texts[i], texts[first->second])});
    }
  }
}

}  // namespace merlin
