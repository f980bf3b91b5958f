#include "render/points/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "render/mesh/non_numbers.h"

namespace merlin::render::points {
namespace {

constexpr float kFarthestPoint = 1e18F;

bool isPoint(const float* p) {
  return std::all_of(p, p + 3, [](float x) { return std::abs(x) <= kFarthestPoint; });
}

// Moves the rows of the points with kept[p] to the front, in order, and removes all others.
void keepRows(const std::vector<bool>& kept, std::size_t dimension, std::vector<float>& values) {
  std::size_t to = 0;
  for (std::size_t p = 0; p < kept.size(); ++p) {
    if (!kept[p]) continue;
    for (std::size_t k = 0; k < dimension; ++k) values[to++] = values[p * dimension + k];
  }
  values.resize(to);
}

}  // namespace

const mesh::Feature* PointCloud::find(std::string_view name) const noexcept {
  const auto found = std::ranges::find(features, name, &mesh::Feature::name);
  return found == features.end() ? nullptr : &*found;
}

Result<Ok> keepFinite(PointCloud& cloud) {
  const std::size_t points = cloud.size();
  std::vector<bool> kept(points);
  for (std::size_t p = 0; p < points; ++p) kept[p] = isPoint(&cloud.positions[3 * p]);
  const auto left = static_cast<std::size_t>(std::count(kept.begin(), kept.end(), true));
  if (left == 0)
    return Error{Errc::kMalformed,
                 fmt::format("has {} points, none with finite coordinates", points)};
  if (left < points) {
    keepRows(kept, 3, cloud.positions);
    for (mesh::Feature& f : cloud.features) keepRows(kept, f.dimension, f.values);
    cloud.notes.push_back(
        fmt::format("{} points without finite coordinates are left out", points - left));
  }
  if (std::string note = mesh::replaceNonNumbers(cloud.features); !note.empty())
    cloud.notes.push_back(std::move(note));
  return Ok{};
}

}  // namespace merlin::render::points
