// The import of point clouds for `merlin mesh import`: the options, and facts about how the surface
// was made.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "daemon/cli/arguments.h"
#include "daemon/cli/foreign_import.h"
#include "render/mesh/origin.h"
#include "render/points/surface_guess.h"

namespace merlin::cli {

// The command-line options for point clouds.
class PointImport {
 public:
  void addTo(Command command);
  bool anyGiven() const;

  render::points::SurfaceSettings surface;

 private:
  std::vector<Argument> arguments_;
};

// Facts about how the surface of a point cloud was made.
struct PointFacts {
  // `trimmed`: number of triangles that were removed because they were too far from all points.
  std::size_t points = 0, trimmed = 0;
  render::points::SurfaceSettings used;
  double spacing = 0;   // median distance to the fourth neighbour [the file's unit]
  std::string normals;  // how the normals were obtained, as a text for a person
  // Origin that must be added to the mesh's coordinates to get those of the file, in the unit of
  // the mesh, that is, after --scale.
  render::mesh::Origin origin{};
  std::string projection;  // map projection of the coordinates; empty: unknown
};

// Returns the parameters for importForeign(), with the settings for the surface and a time limit
// for computing it.
ForeignFile pointFile(const std::string& input, const std::string& output,
                      std::uint64_t memory_bytes, const render::points::SurfaceSettings& settings);

// Returns the facts that merlin-import has reported about a point cloud; missing facts are 0 or
// empty.
PointFacts pointFactsOf(const ForeignReport& report);

// Returns lines for the model's text "about": the projection, if it is known, and the origin in the
// unit of the mesh, unless it is 0 0 0.
std::string aboutPoints(const PointFacts& cloud);

}  // namespace merlin::cli
