#include "render/range/colours.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace merlin::render::range {
namespace {

using Rgb = std::array<float, 3>;  // 0..1

constexpr std::array<Rgb, 5> kBlueToRedStops = {
    {{0, 0, 1}, {0, 1, 1}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}};
constexpr std::array<Rgb, 5> kTerrainStops = {{{0.20F, 0.42F, 0.25F},
                                               {0.55F, 0.67F, 0.36F},
                                               {0.85F, 0.79F, 0.52F},
                                               {0.58F, 0.44F, 0.32F},
                                               {0.96F, 0.96F, 0.96F}}};

// Returns the colour at `share` (0..1) of the scale, interpolated between its stops.
Rgb mixed(const std::array<Rgb, 5>& stops, float share) {
  const float at = 4 * share;
  const std::size_t from = std::min(static_cast<std::size_t>(at), std::size_t{3});
  const float t = at - static_cast<float>(from);
  Rgb colour{};
  for (std::size_t k = 0; k < 3; ++k)
    colour[k] = stops[from][k] + t * (stops[from + 1][k] - stops[from][k]);
  return colour;
}

float shareOf(float value, Ends ends) {
  const double span = double{ends.high} - ends.low;
  if (!(span > 0)) return 0.5F;
  const double share = (double{value} - ends.low) / span;
  return share > 0 ? static_cast<float>(std::min(share, 1.0)) : 0;  // 0 for NaN
}

}  // namespace

Ends endsOf(std::span<const float> values) noexcept {
  Ends ends;
  bool any = false;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    ends = any ? Ends{std::min(ends.low, value), std::max(ends.high, value)} : Ends{value, value};
    any = true;
  }
  return ends;
}

Plane coloursOf(std::span<const float> values, Ends ends, Scale scale) {
  Plane plane{"colour", 3, std::vector<float>(3 * values.size()), "", 0, 1};
  const auto& stops = scale == Scale::kBlueToRed ? kBlueToRedStops : kTerrainStops;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Rgb colour = mixed(stops, shareOf(values[i], ends));
    std::copy(colour.begin(), colour.end(),
              plane.values.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return plane;
}

}  // namespace merlin::render::range
