// Point clouds for `merlin mesh import`: their options, and facts about how their surface was made.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "daemon/cli/arguments.h"
#include "daemon/cli/foreign_import.h"
#include "render/mesh/origin.h"
#include "render/points/surface_guess.h"

namespace merlin::cli {

// The options for point clouds.
class PointImport {
 public:
  void addTo(Command command);
  bool anyGiven() const;

  render::points::SurfaceSettings surface;

 private:
  std::vector<Argument> arguments_;
};

// How the surface of a point cloud was made.
struct PointFacts {
  std::size_t points = 0, trimmed = 0;  // trimmed: triangles that were too far from all points
  render::points::SurfaceSettings used;
  double spacing = 0;   // median distance to the fourth neighbour [the file's unit]
  std::string normals;  // where they come from, for a person
  // Origin of the coordinates in the mesh's unit, i.e. after --scale. The mesh is relative to it.
  render::mesh::Origin origin{};
  std::string projection;  // map projection of the coordinates, as text; empty: unknown
};

// The file for importForeign(), with the surface's settings and the time that a surface takes.
ForeignFile pointFile(const std::string& input, const std::string& output,
                      std::uint64_t memory_bytes, const render::points::SurfaceSettings& settings);

// The facts that merlin-import reported about a point cloud; missing ones are 0 or empty.
PointFacts pointFactsOf(const ForeignReport& report);

// Lines for the model's text "about": the origin, in the mesh's unit, unless it is 0 0 0, and the
// projection, if it is known.
std::string aboutPoints(const PointFacts& cloud);

}  // namespace merlin::cli
