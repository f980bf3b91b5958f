#include "daemon/cli/mesh/import_points.h"

#include <algorithm>

#include <fmt/format.h>

#include "daemon/cli/mesh/input_kinds.h"

namespace merlin::cli {

void PointImport::addTo(Command command) {
  using namespace render::points;
  arguments_.push_back(
      command
          .option("--depth", surface.depth,
                  "Point cloud only: depth of the octree in which the surface is computed (Poisson "
                  "reconstruction); by default derived from the points' spacing; where there are "
                  "too few points for it, cells stay larger")
          .range(kLeastDepth, kMostDepth)
          .typeName("N"));
  arguments_.push_back(command
                           .option("--neighbours", surface.neighbours,
                                   "Point cloud only: number of neighbours from which the normal "
                                   "of a point is computed; 16 by default")
                           .range(kLeastNeighbours, kMostNeighbours)
                           .typeName("K"));
  arguments_.push_back(
      command
          .option("--trim", surface.trim,
                  "Point cloud only: greatest distance of the surface from the nearest point, in "
                  "the file's unit; with 0 nothing is trimmed, and the surface closes over gaps; "
                  "by default derived from the points' spacing")
          .nonNegative()
          .typeName("LENGTH"));
}

bool PointImport::anyGiven() const { return std::ranges::any_of(arguments_, &Argument::isGiven); }

ForeignFile pointFile(const std::string& input, const std::string& output,
                      std::uint64_t memory_bytes, const render::points::SurfaceSettings& settings) {
  // At most a tenth of the measured speed of surface reconstruction.
  constexpr std::uint64_t kBytesPerSecond = 2'000;
  return {kPointsKind,
          input,
          output,
          {"--depth", std::to_string(settings.depth), "--neighbours",
           std::to_string(settings.neighbours), "--trim", fmt::format("{}", settings.trim)},
          memory_bytes,
          kBytesPerSecond};
}

PointFacts pointFactsOf(const ForeignReport& report) {
  PointFacts cloud;
  cloud.points = report.count("points").value_or(0);
  cloud.trimmed = report.count("trimmed").value_or(0);
  cloud.used = {static_cast<int>(std::clamp(report.number("depth"), 0.0, 99.0)),
                static_cast<int>(std::clamp(report.number("neighbours"), 0.0, 999.0)),
                report.number("trim")};
  cloud.spacing = report.number("spacing");
  cloud.normals = report.text("normals");
  const char* axes[] = {"origin_x", "origin_y", "origin_z"};
  for (std::size_t k = 0; k < 3; ++k) cloud.origin[k] = report.number(axes[k]);
  cloud.projection = report.text("projection");
  return cloud;
}

std::string aboutPoints(const PointFacts& cloud) {
  std::string text;
  const auto& origin = cloud.origin;
  if (!cloud.projection.empty()) text += fmt::format("map.projection={}\n", cloud.projection);
  if (origin != render::mesh::Origin{})
    text += fmt::format("points.origin={} {} {}\n", origin[0], origin[1], origin[2]);
  return text;
}

}  // namespace merlin::cli
