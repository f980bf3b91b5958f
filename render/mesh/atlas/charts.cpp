#include "render/mesh/atlas/charts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "render/mesh/disjoint_sets.h"

namespace merlin::render::mesh {
namespace {

constexpr int kTogether = 4;  // periods that connected triangles may span
constexpr std::size_t kMostColours = 1024;
constexpr float kFarthest = 1e6F;          // limit of the magnitude of a texture coordinate
constexpr double kTolerance = 1.0 / 1024;  // for coordinates that should be whole numbers

// The range of texture coordinates on each axis.
struct Range {
  std::array<float, 2> low{kFarthest, kFarthest}, high{-kFarthest, -kFarthest};

  void take(const float* uv) {
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], uv[k]);
      high[k] = std::max(high[k], uv[k]);
    }
  }
};

// Returns the period of an image along an axis, in sides of the image; 0 if it does not repeat.
int periodOf(image::Wrap wrap) {
  return wrap == image::Wrap::kClamp ? 0 : wrap == image::Wrap::kMirror ? 2 : 1;
}

std::array<std::int32_t, 2> shiftOf(const Range& range, const SurfaceTexture& texture) {
  std::array<std::int32_t, 2> shift{};
  const int periods[] = {periodOf(texture.wrap_u), periodOf(texture.wrap_v)};
  for (std::size_t k = 0; k < 2; ++k) {
    if (periods[k] == 0) continue;
    const double low = std::floor((static_cast<double>(range.low[k]) + kTolerance) / periods[k]);
    shift[k] = periods[k] * static_cast<std::int32_t>(low);
  }
  return shift;
}

// Returns whether the coordinates minus `shift` lie between -most and most, in sides of the
// picture.
bool spans(const Range& range, const std::array<std::int32_t, 2>& shift, int most) {
  for (std::size_t k = 0; k < 2; ++k) {
    const double low = static_cast<double>(range.low[k]) - shift[k];
    const double high = static_cast<double>(range.high[k]) - shift[k];
    if (high > most + kTolerance || low < -most - kTolerance) return false;
  }
  return true;
}

// Returns the colour rounded to `bits` bits per component.
Colour rounded(const Colour& colour, int bits) {
  Colour result{};
  const int steps = (1 << bits) - 1;
  for (std::size_t k = 0; k < 3; ++k)
    result[k] = static_cast<std::uint8_t>((colour[k] * steps + 127) / 255 * 255 / steps);
  return result;
}

class ChartFinder {
 public:
  ChartFinder(const Mesh& mesh, const SurfaceTextures& textures, const AtlasLimits& limits)
      : mesh_(mesh),
        textures_(textures),
        limits_(limits),
        texcoord_(mesh.find("texcoord")),
        colour_(mesh.find("colour")) {}

  Charts find() {
    const std::size_t n = mesh_.triangleCount();
    charts_.places.resize(n);
    triangle_colours_.resize(n);
    numberTextures();
    joinTriangles();
    for (std::uint32_t t = 0; t < n; ++t) place(t);
    roundRegions();
    numberColours();
    return std::move(charts_);
  }

 private:
  const std::uint32_t* cornersOf(std::size_t t) const { return &mesh_.triangles[3 * t]; }
  const float* uvOf(std::uint32_t v) const { return &texcoord_->values[2 * std::size_t{v}]; }

  bool isTextured(std::size_t t) const {
    if (textures_.of_triangle[t] == kNoTexture) return false;
    const std::uint32_t* const corners = cornersOf(t);
    return std::all_of(corners, corners + 3, [&](std::uint32_t v) {
      return std::abs(uvOf(v)[0]) <= kFarthest && std::abs(uvOf(v)[1]) <= kFarthest;
    });
  }

  // Maps textures to charts; equal textures share one chart.
  void numberTextures() {
    for (const SurfaceTexture& t : textures_.textures) {
      const auto same = [&](const Chart& c) { return c.texture == t; };
      const auto found = std::ranges::find_if(charts_.charts, same);
      chart_of_.push_back(static_cast<std::uint32_t>(found - charts_.charts.begin()));
      if (found == charts_.charts.end()) charts_.charts.push_back({t});
    }
    regions_.resize(charts_.charts.size());
  }

  // Finds sets of connected triangles and their ranges of texture coordinates. A shared vertex
  // connects triangles even if their textures differ.
  void joinTriangles() {
    connected_ = DisjointSets(mesh_.vertexCount());
    for (std::size_t t = 0; t < mesh_.triangleCount(); ++t) {
      if (!isTextured(t)) continue;
      const std::uint32_t* const c = cornersOf(t);
      connected_.unite(c[0], c[1]);
      connected_.unite(c[0], c[2]);
    }
    ranges_.resize(mesh_.vertexCount());
    for (std::size_t t = 0; t < mesh_.triangleCount(); ++t) {
      if (!isTextured(t)) continue;
      for (std::size_t k = 0; k < 3; ++k)
        ranges_[connected_.rootOf(*cornersOf(t))].take(uvOf(cornersOf(t)[k]));
    }
  }

  void place(std::uint32_t t) {
    if (!isTextured(t)) {
      triangle_colours_[t] = ownColour(t);
      return;
    }
    TrianglePlace& place = charts_.places[t];
    place.chart = chart_of_[textures_.of_triangle[t]];
    const SurfaceTexture& texture = charts_.charts[place.chart].texture;
    const std::uint32_t* const corners = cornersOf(t);
    Range own;
    for (std::size_t k = 0; k < 3; ++k) own.take(uvOf(corners[k]));
    const Range& together = ranges_[connected_.rootOf(*corners)];
    place.shift = shiftOf(together, texture);
    if (!spans(together, place.shift, kTogether)) place.shift = shiftOf(own, texture);
    if (!spans(own, place.shift, limits_.most_repeats)) {
      triangle_colours_[t] = pictureColour(place.chart);
      place = {};
      ++charts_.mean_coloured;
      return;
    }
    for (std::size_t k = 0; k < 3; ++k) take(place, uvOf(corners[k]));
  }

  void take(const TrianglePlace& place, const float* uv) {
    const Chart& chart = charts_.charts[place.chart];
    const auto at = texelsOf(*chart.texture.picture, static_cast<double>(uv[0]) - place.shift[0],
                             static_cast<double>(uv[1]) - place.shift[1]);
    auto& region = regions_[place.chart];
    if (!region) region = Region{at, at};
    for (std::size_t k = 0; k < 2; ++k) {
      region->low[k] = std::min(region->low[k], at[k]);
      region->high[k] = std::max(region->high[k], at[k]);
    }
  }

  // Rounds the regions to charts of whole texels; removes charts that no triangle uses.
  void roundRegions() {
    std::vector<Chart> used;
    std::vector<std::uint32_t> number(charts_.charts.size(), kNoTexture);
    for (std::size_t i = 0; i < regions_.size(); ++i) {
      if (!regions_[i]) continue;
      Chart chart = charts_.charts[i];
      const Region& r = *regions_[i];
      const auto first = [&](std::size_t k) { return std::floor(r.low[k] + kTolerance); };
      const auto size = [&](std::size_t k) {
        return std::max(1, static_cast<int>(std::ceil(r.high[k] - kTolerance) - first(k)));
      };
      chart.x = static_cast<std::int64_t>(first(0));
      chart.y = static_cast<std::int64_t>(first(1));
      chart.width = size(0);
      chart.height = size(1);
      number[i] = static_cast<std::uint32_t>(used.size());
      used.push_back(chart);
    }
    charts_.charts = std::move(used);
    for (TrianglePlace& p : charts_.places) {
      if (p.chart != kNoTexture) p.chart = number[p.chart];
    }
  }

  Colour ownColour(std::size_t t) const {
    Colour mean{255, 255, 255};
    if (!colour_ || colour_->dimension != 3) return mean;
    for (std::size_t k = 0; k < 3; ++k) {
      float sum = 0;
      for (std::size_t corner = 0; corner < 3; ++corner)
        sum += colour_->values[3 * std::size_t{cornersOf(t)[corner]} + k];
      mean[k] = static_cast<std::uint8_t>(std::lround(std::clamp(sum / 3, 0.0F, 1.0F) * 255));
    }
    return mean;
  }

  const Colour& pictureColour(std::uint32_t chart) {
    const auto [found, fresh] = means_.try_emplace(chart);
    if (fresh) found->second = meanOf(*charts_.charts[chart].texture.picture);
    return found->second;
  }

  // Numbers the colours. If there are more than kMostColours, rounds them more and more coarsely
  // until they are few enough.
  void numberColours() {
    for (int bits = 8;; --bits) {
      charts_.colours.clear();
      charts_.rounded_colours = 0;
      if (tryToNumber(bits)) return;
    }
  }

  bool tryToNumber(int bits) {
    std::map<Colour, std::uint32_t> numbers;
    for (std::size_t t = 0; t < charts_.places.size(); ++t) {
      if (charts_.places[t].chart != kNoTexture) continue;
      const Colour colour = rounded(triangle_colours_[t], bits);
      charts_.rounded_colours += colour != triangle_colours_[t];
      const auto next = static_cast<std::uint32_t>(charts_.colours.size());
      const auto [found, fresh] = numbers.try_emplace(colour, next);
      if (fresh) charts_.colours.push_back(colour);
      charts_.places[t].colour = found->second;
      if (charts_.colours.size() > kMostColours) return false;
    }
    return true;
  }

  struct Region {
    std::array<double, 2> low, high;  // [texels]
  };

  const Mesh& mesh_;
  const SurfaceTextures& textures_;
  const AtlasLimits& limits_;
  const Feature* texcoord_;
  const Feature* colour_;
  Charts charts_;
  std::vector<std::uint32_t> chart_of_;  // by texture: index of its chart
  // By chart: the part of its image that is used; nothing if unused.
  std::vector<std::optional<Region>> regions_;
  DisjointSets connected_{0};             // sets of vertices that triangles connect
  std::vector<Range> ranges_;             // by root vertex: range of a set of connected triangles
  std::vector<Colour> triangle_colours_;  // by triangle; only for triangles without a chart
  std::map<std::uint32_t, Colour> means_;
};

}  // namespace

Colour meanOf(const image::ImageFile& picture) noexcept {
  std::array<std::uint64_t, 3> sum{};
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) sum[i % 3] += picture.pixels[i];
  const std::uint64_t n = picture.pixels.size() / 3;
  Colour mean{};
  for (std::size_t k = 0; k < 3; ++k) mean[k] = static_cast<std::uint8_t>((sum[k] + n / 2) / n);
  return mean;
}

std::array<double, 2> texelsOf(const image::ImageFile& picture, double u, double v) noexcept {
  return {u * picture.width, (1 - v) * picture.height};
}

Charts findCharts(const Mesh& mesh, const SurfaceTextures& textures, const AtlasLimits& limits) {
  return ChartFinder(mesh, textures, limits).find();
}

}  // namespace merlin::render::mesh
