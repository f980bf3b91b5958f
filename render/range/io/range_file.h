// Reads range images and elevation maps, and writes range images as PGM or FITS. A file's content
// decides its format, not its ending.
//
//   PGM, 8 and 16 bits     ranges; the header's comments carry the geometry (README.md)
//   raw binary             ranges and other planes, described by RangeOptions::raw
//   PCD                    organised points; ascii, binary, binary_compressed
//   PLY with a range_grid  points on a grid; ascii, both byte orders
//   HGT, ESRI ASCII grid   heights
//
// Nothing in a file is trusted before it has been checked. Nothing throws, nothing is printed.
// Reentrant.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/range/io/image_header.h"
#include "render/range/io/raw.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

// Settings of the caller, which override what the file says.
struct RangeOptions {
  std::optional<Scanner> scanner{};                   // not kRays
  std::optional<std::array<double, 2>> angles_deg{};  // horizontal, vertical
  std::string angle_table{};                          // a file, angle_table.h
  std::optional<double> scale{};                      // metres per unit of the file's values
  std::optional<std::array<double, 2>> cell{};        // of an elevation map
  std::optional<double> exaggeration{};               // of an elevation map
  std::optional<double> no_return{};                  // the stored value of pixels without a return
  std::optional<RawLayout> raw{};                     // the file is raw binary
};

struct LoadedRange {
  RangeImage image;
  std::string format;                 // "PGM", ...
  std::vector<FeatureFile> features;  // named in the file, but not read
  std::vector<std::string> notes;     // for the user: what was left out or assumed
  // Whether the lengths are known to be metres: from a scale, from the ranges of the smallest and
  // the largest stored number, from the unit, or because the image is a map.
  bool in_metres = false;
};

// Whether readRange(), without options.raw, supports this file, judged by its beginning and its
// name. False also if it cannot be opened.
bool isRangeFile(const std::string& path);

// Returns the names of the formats that readRange() reads, for error messages and help.
std::string readableRanges();

// The returned image has at least one return and a geometry without fault (faultOf()). Ranges that
// are not numbers, not positive or beyond kFarthest count as no return; heights may be negative.
// The scale applies to ranges, to heights and to the points of a PCD. Errors, with the file's name
// and the place in it: kNotFound, kIo, kMalformed, kUnsupported, kInvalidArgument (an option that
// does not apply to this kind of file, or a missing one).
Result<LoadedRange> readRange(const std::string& path, const RangeOptions& options);

// As readRange(), but reads the grid at `path` that merlin-import has made from the file `name`
// (grid_file.h). Errors: those of readRange(), with `name` in place of the path.
Result<LoadedRange> readGrid(const std::string& path, const std::string& name,
                             const RangeOptions& options);

// Whether writeRange() writes this path as FITS, with exact ranges, i.e. it ends in ".fits".
bool isFitsName(const std::string& path);

// Writes the ranges of an image, with its geometry and the names of the files of its features: as
// FITS with floats if isFitsName(), else as PGM with 16 bits. Errors: those of writeFile();
// kUnsupported for kRays, and for an elevation map as FITS, since the formats cannot hold their
// geometry.
Result<Ok> writeRange(const std::string& path, const RangeImage& image,
                      const std::vector<FeatureFile>& features = {});

}  // namespace merlin::render::range
