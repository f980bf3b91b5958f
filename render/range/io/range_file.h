// Reads range images and elevation maps, and writes range images as PGM; a file's content decides
// what it is, not its ending.
//
//   PGM, 8 and 16 bits     ranges; the header's comments carry the geometry (README.md)
//   raw binary             ranges and other planes, described by RangeOptions::raw
//   PCD                    organised points; ascii, binary, binary_compressed
//   PLY with a range_grid  points on a grid; ascii, both byte orders
//   HGT, ESRI ASCII grid   heights
//
// Everything in a file is hostile until it has been checked. Nothing throws, nothing is printed.
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

// What the caller knows better than the file.
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
  std::vector<FeatureFile> features;  // that the file names; they are not read
  std::vector<std::string> notes;     // for the user: what was left out or assumed
  // Whether something says that the lengths are metres: a scale, the values of the smallest and the
  // largest stored number, the unit, or that it is a map.
  bool in_metres = false;
};

// Whether readRange() without options.raw is for a file that begins, or is named, like this.
// Reads the file's beginning. False also if it cannot be opened.
bool isRangeFile(const std::string& path);

// What isRangeFile() recognises, for messages and help.
std::string readableRanges();

// The returned image has at least one return and a geometry without fault (faultOf()). Ranges that
// are not numbers, not positive or beyond kFarthest are no return; heights may be negative. The
// scale applies to ranges and heights, to points of a PCD likewise. Errors, with the file's name
// and the place in it: kNotFound, kIo, kMalformed, kUnsupported, kInvalidArgument (an option that
// this kind of file does not take, or one that is missing).
Result<LoadedRange> readRange(const std::string& path, const RangeOptions& options);

// Reads the grid at `path` that merlin-import made of the file `name` (grid_file.h), as readRange()
// reads a file. Errors: those of readRange(), with `name` in place of the path.
Result<LoadedRange> readGrid(const std::string& path, const std::string& name,
                             const RangeOptions& options);

// Whether writeRange() writes the path as FITS, with exact ranges: it ends in ".fits".
bool isFitsName(const std::string& path);

// Writes the ranges of an image, with its geometry and the names of the files of its features: as
// FITS of floats if isFitsName(), else as a PGM of 16 bits. Errors: those of
// writeFile(); kUnsupported for points with a ray each, and for an elevation map as FITS, since the
// format has no place for their geometry.
Result<Ok> writeRange(const std::string& path, const RangeImage& image,
                      const std::vector<FeatureFile>& features = {});

}  // namespace merlin::render::range
