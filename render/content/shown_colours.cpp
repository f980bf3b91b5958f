#include "render/content/shown_colours.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace merlin::render::content {
namespace {

using Rgb = std::array<float, 3>;  // 0..1

std::uint8_t quantiseColour(float value) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0F, 1.0F)));
}

float finite(float value) { return std::isfinite(value) ? value : 0; }

// The colour map viridis of Matplotlib (CC0), interpolated linearly between five of its colours:
// perceptually uniform, and readable with red-green colour blindness. `share`: 0..1.
Rgb scale(float share) {
  constexpr Rgb kStops[] = {{0.267F, 0.005F, 0.329F},
                            {0.230F, 0.322F, 0.546F},
                            {0.128F, 0.567F, 0.551F},
                            {0.369F, 0.789F, 0.383F},
                            {0.993F, 0.906F, 0.144F}};
  const float at = 4 * std::clamp(share, 0.0F, 1.0F);
  const auto from = std::min(static_cast<std::size_t>(at), std::size_t{3});
  const float t = at - static_cast<float>(from);
  Rgb colour{};
  for (std::size_t k = 0; k < 3; ++k)
    colour[k] = kStops[from][k] + t * (kStops[from + 1][k] - kStops[from][k]);
  return colour;
}

// Hues of successive labels are a golden angle apart, so that nearby labels differ clearly.
Rgb colourOfLabel(float label) {
  const double turns = 0.61803398875 * std::fabs(std::round(static_cast<double>(label))) + 0.05;
  const auto hue = static_cast<float>(6 * std::fmod(turns, 1.0));
  Rgb colour{};
  for (std::size_t k = 0; k < 3; ++k) {
    const float away = std::fabs(std::fmod(hue + 6 - 2 * static_cast<float>(k), 6.0F) - 3);
    colour[k] = 0.25F + 0.75F * std::clamp(away - 1, 0.0F, 1.0F);
  }
  return colour;
}

// Sets the range to the 1st and 99th percentile of the values at the leaves, i.e. the vertices of
// the full resolution.
void findRange(const lod::Dendrogram& model, std::span<const float> values, ShownColours& shown) {
  std::vector<float> leaves;
  std::vector<bool> seen(model.nodeCount());
  for (const std::uint32_t node : model.arrays().triangles) {
    if (seen[node] || !std::isfinite(values[node])) continue;
    seen[node] = true;
    leaves.push_back(values[node]);
  }
  if (leaves.empty()) return;
  const auto percentile = [&](std::size_t percent) {
    const auto at =
        leaves.begin() + static_cast<std::ptrdiff_t>((leaves.size() - 1) * percent / 100);
    std::nth_element(leaves.begin(), at, leaves.end());
    return *at;
  };
  shown.low = percentile(1);
  shown.high = percentile(99);
}

Error noSuchFeature(const lod::Dendrogram& model, std::string_view feature) {
  std::vector<std::string> names;
  for (const lod::FeatureView& f : model.arrays().features) {
    if (f.dimension == 1 || f.dimension == 3) names.push_back(f.name);
  }
  return {Errc::kInvalidArgument,
          fmt::format("the model has no feature \"{}\" that can be shown; {}", feature,
                      names.empty() ? "it has none of dimension 1 or 3"
                                    : fmt::format("it has {}", fmt::join(names, ", ")))};
}

Rgb colourOf(const lod::FeatureView& feature, std::size_t node, const ShownColours& shown) {
  const float* v = &feature.values[node * feature.dimension];
  if (feature.dimension == 3) {
    const Rgb rgb{finite(v[0]), finite(v[1]), finite(v[2])};
    if (feature.name != "normal") return rgb;
    return {0.5F + rgb[0] / 2, 0.5F + rgb[1] / 2, 0.5F + rgb[2] / 2};
  }
  if (feature.name == "label") return colourOfLabel(finite(*v));
  const double low = static_cast<double>(shown.low), span = static_cast<double>(shown.high) - low;
  return scale(span > 0 ? static_cast<float>((static_cast<double>(finite(*v)) - low) / span)
                        : 0.5F);
}

}  // namespace

Result<Ok> checkShown(const lod::Dendrogram& model, const ShownFeature& show) {
  if (show.feature.empty()) return Ok{};
  const lod::FeatureView* f = model.find(show.feature);
  if (!f || (f->dimension != 1 && f->dimension != 3)) return noSuchFeature(model, show.feature);
  return Ok{};
}

Result<ShownColours> coloursOf(const lod::Dendrogram& model, const ShownFeature& show) {
  const std::string& feature = show.feature;
  const lod::FeatureView* f = model.find(feature.empty() ? std::string_view("colour") : feature);
  const bool usable = f && (f->dimension == 3 || (f->dimension == 1 && !feature.empty()));
  ShownColours shown;
  if (!usable && feature.empty()) return shown;
  if (const auto checked = checkShown(model, show); !checked) return checked.error();
  shown.low = show.range[0];
  shown.high = show.range[1];
  if (f->dimension == 1 && f->name != "label" && shown.low == shown.high)
    findRange(model, f->values, shown);
  shown.rgb.resize(model.nodeCount());
  for (std::size_t n = 0; n < shown.rgb.size(); ++n) {
    const Rgb colour = colourOf(*f, n, shown);
    for (std::size_t k = 0; k < 3; ++k) shown.rgb[n][k] = quantiseColour(colour[k]);
  }
  return shown;
}

}  // namespace merlin::render::content
