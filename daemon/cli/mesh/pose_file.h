// A scanner's pose in a file of its own.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "render/range/range_image.h"

namespace merlin::cli {

// Reads three or four rows of four numbers, separated by spaces or new lines: rotation and
// translation from the scanner's coordinates to the world's; a fourth row is 0 0 0 1. Whether it is
// a rotation is checked by range::faultOf() only. Errors, with the file's name: kNotFound, kIo,
// kMalformed.
Result<render::range::Pose> readPose(const std::string& path);

}  // namespace merlin::cli
