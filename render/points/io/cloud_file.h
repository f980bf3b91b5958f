// Reads point clouds; a file's content, not its ending, determines the format.
//
//   LAS    1.2 to 1.4, point formats 0 to 10; LAZ is refused, with the command that converts it
//   PCD    points without rows and columns; ascii, binary, binary_compressed
//   PLY    without faces; ascii, both byte orders
//   XYZ    text: x y z, with an intensity, a colour or a normal
//   E57    is refused, with the command that converts it
//
// Nothing in a file is trusted before it has been checked. Nothing throws, nothing is printed.
// Reentrant.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "render/points/point_cloud.h"

namespace merlin::render::points {

// Returns the format of a point cloud whose file begins with `bytes`: "LAS", "PCD", ... . Also
// returns "E57", although parseCloud() rejects it with an error that explains how to convert the
// file. Returns nothing for any other file.
std::optional<std::string> cloudFormatOf(std::string_view bytes);

// Returns "XYZ" if `bytes` look like a text file of points, else nothing. Such a file has no
// identifying mark, so readers of other formats should be asked first.
std::optional<std::string> textCloudFormatOf(std::string_view bytes);

// Returns the list of supported formats, for messages and help.
std::string readableClouds();

// Parses a point cloud; `bytes` is the whole file. The result has at least one point, and all
// points are finite. Errors, with the place: kMalformed, kUnsupported.
Result<PointCloud> parseCloud(std::string_view bytes);

// Reads and parses a point cloud file. Errors, with the file's name: those of parseCloud(),
// kNotFound, kIo, kNoMemory (the file is too large).
Result<PointCloud> readCloud(const std::string& path);

}  // namespace merlin::render::points
