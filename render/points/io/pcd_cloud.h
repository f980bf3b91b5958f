// Converts PCD files whose points are not in rows and columns to point clouds.
// render/range/io/pcd_body reads the header and the numbers.
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "render/points/point_cloud.h"

namespace merlin::render::points {

// Returns whether the bytes are the beginning of a PCD file of HEIGHT 1.
bool isPcdCloud(std::string_view bytes);

// Parses a PCD file; `bytes` is the whole file. The field rgb or rgba becomes the feature "colour";
// normal_x, normal_y and normal_z become "normal"; any other field except "_" becomes a feature
// with the field's name. The viewpoint is used unless it is the format's default, 0 0 0. Errors:
// those of parsePcdHeader() and readPcdBody(); kMalformed (no x, y or z).
Result<PointCloud> parsePcdCloud(std::string_view bytes);

}  // namespace merlin::render::points
