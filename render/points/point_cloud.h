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

// Where the scanner was, which tells the outer side of the surface.
enum class Side {
  kUnknown,
  kViewpoint,  // at PointCloud::viewpoint
  kAbove       // an aircraft: the surface is seen from +z
};

struct PointCloud {
  mesh::Origin origin{};         // what was subtracted from the file's coordinates
  std::vector<float> positions;  // points x 3, the file's unit
  // As in a mesh: "normal" (3), "colour" (3, 0..1), "label" (a classification); others are data.
  std::vector<mesh::Feature> features;
  Side side = Side::kUnknown;
  std::array<float, 3> viewpoint{};  // relative to the origin
  std::string format;                // "LAS 1.4", ...
  std::string projection{};          // of the coordinates, as text (WKT or EPSG:N); empty: unknown
  std::vector<std::string> notes;    // for the user: what was left out or assumed

  std::size_t size() const noexcept { return positions.size() / 3; }
  const mesh::Feature* find(std::string_view name) const noexcept;  // nullptr if there is none
};

// Removes points with a coordinate that is not finite or whose magnitude is above 10^18, and adds a
// note with their number. Sets feature values that are not numbers to 0, and adds a note. Order is
// kept. Errors: kMalformed (no point is left). REQUIRES: every feature has a value for every point.
Result<Ok> keepFinite(PointCloud& cloud);

}  // namespace merlin::render::points
