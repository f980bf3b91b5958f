// Reads the pose of a scanner from a file.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "render/range/range_image.h"

namespace merlin::cli {

// Reads a file with three or four rows of four numbers, separated by spaces or line feeds: rotation
// and translation from the scanner's coordinates to the world's; the fourth row must be 0 0 0 1.
// Does not check that the matrix is a rotation; range::faultOf() does. Errors, with the file's
// name: kNotFound, kIo, kMalformed.
Result<render::range::Pose> readPose(const std::string& path);

}  // namespace merlin::cli
