// Reads range images and elevation maps, and writes range images as PGM or FITS. A file's content,
// not its ending, determines its format.
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

// Settings of the caller; they override the values in the file.
struct RangeOptions {
  std::optional<Scanner> scanner{};                   // not kRays
  std::optional<std::array<double, 2>> angles_deg{};  // horizontal, vertical
  // Path of a table of angles (angle_table.h); empty: none.
  std::string angle_table{};
  std::optional<double> scale{};  // metres per unit of the file's values
  // Elevation map: width and height of a cell [metres].
  std::optional<std::array<double, 2>> cell{};
  std::optional<double> exaggeration{};  // elevation map: factor of the heights
  std::optional<double> no_return{};     // stored value of pixels without a return
  std::optional<RawLayout> raw{};        // layout, if the file is raw binary
};

struct LoadedRange {
  RangeImage image;
  std::string format;                 // name of the file's format: "PGM", ...
  std::vector<FeatureFile> features;  // files that the range file names; they are not read
  std::vector<std::string> notes;     // notes for the user: what was left out or assumed
  // Whether the lengths are known to be metres. They are if there is a scale, if the file gives the
  // ranges of the smallest and the largest stored number, if its unit is metres, or if the image is
  // an elevation map; for a range image with another unit and no scale they are not.
  bool in_metres = false;
};

// Returns whether readRange(), without options.raw, supports this file, judged by its beginning and
// its name. Returns false if the file cannot be opened.
bool isRangeFile(const std::string& path);

// Returns the names of the formats that readRange() reads, for error messages and help.
std::string readableRanges();

// Reads a range image or an elevation map. The returned image has at least one return and a
// geometry without fault (faultOf()). Ranges that are not numbers, not positive or beyond kFarthest
// count as no return; heights may be negative. The scale applies to ranges, to heights and to the
// points of a PCD. Errors, with the file's name and the place in it: kNotFound, kIo, kMalformed,
// kUnsupported, kInvalidArgument (an option that does not apply to this kind of file, or is
// missing).
Result<LoadedRange> readRange(const std::string& path, const RangeOptions& options);

// Does what readRange() does for the grid at `path` that merlin-import has made from the file
// `name` (grid_file.h). Errors: those of readRange(), with `name` in place of the path.
Result<LoadedRange> readGrid(const std::string& path, const std::string& name,
                             const RangeOptions& options);

// Returns whether writeRange() writes this path as FITS, with exact ranges, i.e. whether the path
// ends in ".fits".
bool isFitsName(const std::string& path);

// Writes the ranges of an image, with its geometry and the names of the files of its features: as
// FITS with floats if isFitsName(), else as PGM with 16 bits. Errors: those of writeFile();
// kUnsupported for kRays, and for an elevation map as FITS, since the formats cannot hold their
// geometry.
Result<Ok> writeRange(const std::string& path, const RangeImage& image,
                      const std::vector<FeatureFile>& features = {});

}  // namespace merlin::render::range
