#include "render/correct/correction_map.h"

#include <algorithm>
#include <cmath>

#include "render/correct/blend.h"

namespace merlin::render::correct {
namespace {

// Interpolates bilinearly between the centres of the cells; outside the outermost centres, the
// value of the nearest one holds. x, y: 0..1 of the output.
float shareAt(const MeasuredShares& m, double x, double y) {
  const double column = std::clamp(x * m.columns - 0.5, 0.0, m.columns - 1.0);
  const double row = std::clamp(y * m.rows - 0.5, 0.0, m.rows - 1.0);
  const int i = static_cast<int>(column), j = static_cast<int>(row);
  const int right = std::min(i + 1, m.columns - 1), below = std::min(j + 1, m.rows - 1);
  const auto at = [&](int c, int r) {
    return static_cast<double>(
        m.shares[static_cast<std::size_t>(r) * static_cast<std::size_t>(m.columns) +
                 static_cast<std::size_t>(c)]);
  };
  const double fx = column - i, fy = row - j;
  const double upper = at(i, j) + fx * (at(right, j) - at(i, j));
  const double lower = at(i, below) + fx * (at(right, below) - at(i, below));
  return static_cast<float>(upper + fy * (lower - upper));
}

// Returns the part, 0..1, of a pixel-wide interval around `at` that lies within the picture, along
// one axis [px]. `at`: 0 is the centre of the first pixel.
double coverage(double at, int size) { return std::clamp(std::min(at + 1, size - at), 0.0, 1.0); }

std::int32_t fixed(double at, int size) {
  const double clamped = std::clamp(at, 0.0, size - 1.0);
  return static_cast<std::int32_t>(std::lround(clamped * CorrectionMap::kOne));
}

std::uint16_t share(double x) {
  return static_cast<std::uint16_t>(
      std::lround(std::clamp(x, 0.0, 1.0) * CorrectionMap::kFullShare));
}

Light lightOf(const CorrectionSettings& s, const MeasuredCorrection* measured) {
  Light light;
  light.gamma = static_cast<float>(s.blend.gamma);
  light.least_headroom = measured ? 0 : 1;
  const auto& level = measured ? measured->beta_level : s.black.level;
  for (std::size_t i = 0; i < 9; ++i) light.matrix[i] = static_cast<float>(s.colour.matrix[i]);
  for (std::size_t c = 0; c < 3; ++c) {
    light.gain[c] = static_cast<float>(s.colour.gain[c]);
    light.encode[c] = static_cast<float>(1 / (s.blend.gamma * s.colour.gamma[c]));
    light.black[c] = static_cast<float>(level[c]);
  }
  return light;
}

// Returns which steps of the formula the run of pixels from `first` on needs. `all`: true if the
// correction changes the light of every pixel.
RunKind kindOf(const CorrectionMap& map, std::size_t first, bool all) {
  bool shown = false, changed = all;
  for (std::size_t i = first; i < first + kRun; ++i) {
    shown |= map.gain[i] > 0 || map.black[i] > 0;
    changed |= map.gain[i] != CorrectionMap::kFullShare || map.black[i] > 0;
  }
  return !shown ? RunKind::kNothing : changed ? RunKind::kLight : RunKind::kGeometry;
}

// Returns the settings for one part of the signal, whose picture the projector stretches by the
// number of parts in each direction.
CorrectionSettings squeezed(CorrectionSettings s, SignalParts parts) {
  for (std::size_t corner = 0; corner < 4; ++corner) {
    s.corners[2 * corner] /= parts.columns;
    s.corners[2 * corner + 1] /= parts.rows;
  }
  for (double* const width : {&s.blend.left, &s.blend.right}) *width /= parts.columns;
  for (double* const height : {&s.blend.top, &s.blend.bottom}) *height /= parts.rows;
  return s;
}

CorrectionMap emptyMap(int width, int height) {
  CorrectionMap map;
  map.width = map.source_width = width;
  map.height = map.source_height = height;
  map.stride = (width + kRun - 1) / kRun * kRun;
  const auto entries = static_cast<std::size_t>(map.stride) * static_cast<std::size_t>(height);
  map.source_x.assign(entries, 0);
  map.source_y.assign(entries, 0);
  map.gain.assign(entries, 0);
  map.black.assign(entries, 0);
  map.runs.assign(entries / kRun, RunKind::kNothing);
  return map;
}

// Repeats the map for each part of the signal.
CorrectionMap repeated(const CorrectionMap& part, SignalParts parts, bool all) {
  CorrectionMap map = emptyMap(part.width * parts.columns, part.height * parts.rows);
  map.light = part.light;
  for (int y = 0; y < map.height; ++y) {
    const auto to = static_cast<std::size_t>(y) * static_cast<std::size_t>(map.stride);
    const auto from =
        static_cast<std::size_t>(y % part.height) * static_cast<std::size_t>(part.stride);
    const int below = y / part.height * part.height;
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = to + static_cast<std::size_t>(x);
      const std::size_t k = from + static_cast<std::size_t>(x % part.width);
      map.source_x[i] = part.source_x[k] + x / part.width * part.width * CorrectionMap::kOne;
      map.source_y[i] = part.source_y[k] + below * CorrectionMap::kOne;
      map.gain[i] = part.gain[k];
      map.black[i] = part.black[k];
    }
    for (std::size_t x = 0; x < static_cast<std::size_t>(map.stride); x += kRun)
      map.runs[(to + x) / kRun] = kindOf(map, to + x, all);
  }
  return map;
}

CorrectionMap makeMap(const CorrectionSettings& settings, int width, int height,
                      const MeasuredCorrection* measured, Threads threads, bool all) {
  CorrectionMap map = emptyMap(width, height);
  map.light = lightOf(settings, measured);
  const std::vector<Place> places =
      Warp(settings, width, height, measured ? &measured->warp : nullptr).places(threads);
  const Shares shares = sharesOf(settings, width, height, places, measured);
  forBlocks(threads, static_cast<std::size_t>(height), [&](std::size_t y) {
    const std::size_t from = y * static_cast<std::size_t>(width);
    const std::size_t to = y * static_cast<std::size_t>(map.stride);
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
      const Place p = places[from + x];
      if (std::isnan(p.u) || std::isnan(p.v)) continue;
      const double at_x = static_cast<double>(p.u) * width - 0.5;
      const double at_y = static_cast<double>(p.v) * height - 0.5;
      const double covered = coverage(at_x, width) * coverage(at_y, height);
      map.source_x[to + x] = fixed(at_x, width);
      map.source_y[to + x] = fixed(at_y, height);
      map.gain[to + x] = share(std::sqrt(covered * static_cast<double>(shares.gain[from + x])));
      map.black[to + x] = share(covered * static_cast<double>(shares.black[from + x]));
    }
    for (std::size_t x = 0; x < static_cast<std::size_t>(map.stride); x += kRun)
      map.runs[(to + x) / kRun] = kindOf(map, to + x, all);
  });
  return map;
}

}  // namespace

Shares sharesOf(const CorrectionSettings& s, int width, int height, std::span<const Place> places,
                const MeasuredCorrection* measured) {
  Shares shares;
  shares.gain.assign(places.size(), 0);
  shares.black.assign(places.size(), 0);
  const Homography pin(pinnedCorners(s, width, height));
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (std::isnan(places[i].u) || std::isnan(places[i].v)) continue;
    if (!measured) {
      const double x = static_cast<double>(places[i].u) * width;
      const double y = static_cast<double>(places[i].v) * height;
      shares.gain[i] = static_cast<float>(blendGain(s.blend, x, y, width, height));
      if (!s.black.isOff())
        shares.black[i] = static_cast<float>(blackShare(s.blend, x, y, width, height));
      continue;
    }
    const std::size_t column = i % static_cast<std::size_t>(width);
    const std::size_t row = i / static_cast<std::size_t>(width);
    const Point on = pin.unmap({static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5})
                         .value_or(Point{});
    shares.gain[i] = measured->alpha ? shareAt(*measured->alpha, on.x, on.y) : 1;
    shares.black[i] = measured->beta ? shareAt(*measured->beta, on.x, on.y) : 0;
  }
  return shares;
}

CorrectionMap makeCorrectionMap(const CorrectionSettings& settings, int width, int height,
                                const MeasuredCorrection* measured, Threads threads,
                                SignalParts parts) {
  const bool all = !settings.colour.isOff() || !settings.black.isOff();
  if (parts == SignalParts{}) return makeMap(settings, width, height, measured, threads, all);
  const CorrectionMap part = makeMap(squeezed(settings, parts), width / parts.columns,
                                     height / parts.rows, measured, threads, all);
  return repeated(part, parts, all);
}

}  // namespace merlin::render::correct
