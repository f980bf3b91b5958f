// PointCloud: points without triangles, with any number of named features, in flat arrays.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"
#include "render/mesh/origin.h"

namespace merlin::render::points {

inline constexpr std::size_t kMostPoints = std::size_t{1} << 28;

// The position of the scanner, which determines the outer side of the surface.
enum class Side {
  kUnknown,
  kViewpoint,  // at PointCloud::viewpoint
  kAbove       // in an aircraft: the surface is seen from +z
};

struct PointCloud {
  mesh::Origin origin{};         // offset that was subtracted from the file's coordinates
  std::vector<float> positions;  // points x 3 [the file's unit]
  // Features as in a mesh: "normal" (3), "colour" (3, 0..1), "label" (a classification); all other
  // names are plain data.
  std::vector<mesh::Feature> features;
  Side side = Side::kUnknown;
  std::array<float, 3> viewpoint{};  // scanner position relative to `origin`, if kViewpoint
  std::string format;                // format of the file: "LAS 1.4", ...
  // Projection of the coordinates (WKT or EPSG:N); empty: unknown.
  std::string projection{};
  std::vector<std::string> notes;  // for the user: what was left out or assumed

  std::size_t size() const noexcept { return positions.size() / 3; }
  // Nullptr if there is no such feature.
  const mesh::Feature* find(std::string_view name) const noexcept;
};

// Removes points with a coordinate that is not finite or whose magnitude is above 10^18, and adds a
// note with their number. Sets feature values that are not finite numbers to 0, and adds a note.
// The order of the points is kept. Errors: kMalformed (no point is left). REQUIRES: every feature
// has a value for every point.
Result<Ok> keepFinite(PointCloud& cloud);

}  // namespace merlin::render::points
