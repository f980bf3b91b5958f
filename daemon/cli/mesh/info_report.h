// The facts that `merlin mesh info` prints, and functions that print them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "daemon/cli/mesh/mesh.h"
#include "render/mesh/inspect.h"
#include "render/mesh/origin.h"

namespace merlin::cli {

struct FeatureInfo {
  std::string name, unit;  // unit: empty if it is not known
  std::size_t dimension = 1;
  render::mesh::ValueRange range;
};

struct ImageInfo {
  std::size_t width = 0, height = 0,
              returns = 0;  // [px]; `returns`: number of pixels with a return
  std::string geometry;
};

struct CloudInfo {
  // `coincident`: number of points at the position of an earlier point.
  std::size_t points = 0, coincident = 0;
};

struct LevelInfo {
  std::size_t levels = 1, coarsest = 0;  // `coarsest`: number of triangles of the coarsest level
  // Error estimate of the coarsest level [model units].
  float error = 0;
};

// The facts about a file of any kind.
struct FileInfo {
  std::string file, format;
  std::size_t triangles = 0, vertices = 0;
  std::optional<ImageInfo> image{};  // for range images and elevation maps
  std::optional<CloudInfo> cloud{};  // for point clouds
  LevelInfo levels{};
  std::optional<std::size_t> parts{};  // for a foreign format
  std::vector<FeatureInfo> features{};
  std::size_t texture_bytes = 0;
  std::string unit{};             // of the coordinates; empty if it is not known
  render::mesh::Origin origin{};  // of the coordinates; the bounding box is relative to it
  std::string projection{};       // of the coordinates; empty if it is not known
  render::mesh::Inspection is{};
  std::vector<Repair> repairs{};  // repairs that were made while reading
  std::string mended{}, about{};
};

void printInfoJson(const FileInfo& info);
void printInfoText(const FileInfo& info);

}  // namespace merlin::cli
