// Reads and writes the file format in which merlin-import passes range images and elevation maps,
// which it has read from formats of other programs, to merlin:
//
//   MERLIN grid 1
//   size: 344 403
//   format: USGS DEM
//   geometry: elevation        (and the other keys of a PGM's comments, README.md)
//   latitude: 46.2             the cells are in degrees, at this latitude; else in metres
//   note: ...                  for the user, at most 16 of them
//   values
//
// then width x height floats, little-endian, rows from top to bottom; NaN: no return.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/files.h"
#include "daemon/base/result.h"
#include "render/range/io/stored_image.h"

namespace merlin::render::range {

struct GridHead {
  std::size_t width = 0, height = 0;
  std::string format{};  // name of the original format, one line, such as "FITS"
  ImageHeader header{};  // ImageHeader::columns is not stored
  // Latitude of the map's middle; if set, header.cell is in degrees.
  std::optional<double> latitude_deg{};
  std::vector<std::string> notes{};  // notes for the user, one line each
};

bool isGrid(std::string_view bytes) noexcept;

struct ParsedGrid {
  StoredImage image;  // the image, with cells in metres
  std::string format;
};

// Parses a grid file. Checks everything, since the file comes from a program that has read an
// untrusted file. Errors, with the line: kMalformed.
Result<ParsedGrid> parseGrid(std::string_view bytes);

// Callback that sets the values of a row and returns true; if it returns false, writeGrid() stops.
using ReadRow = std::function<bool(std::size_t row, std::span<float> values)>;

// Writes the head and all rows. Returns false if `write` or `read` returned false. REQUIRES: width
// and height are at least 1, their product at most kMostPixels.
bool writeGrid(const GridHead& head, const WriteBytes& write, const ReadRow& read);

}  // namespace merlin::render::range
