// Parses elevation maps: tiles of the Shuttle Radar Topography Mission (HGT) and ESRI ASCII grids.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "render/range/io/stored_image.h"

namespace merlin::render::range {

// Returns the lengths of a degree of longitude and of a degree of latitude at this latitude, on the
// ellipsoid WGS 84 [metres].
std::array<double, 2> metresPerDegree(double latitude_deg);

// Parses an HGT tile: 1201 x 1201 or 3601 x 3601 heights of 16 bits, big-endian; -32768 marks a
// missing height. The beginning of `name`, the file's name (N44W072), gives the position of the
// tile: it becomes the origin, with EPSG:4326 as projection, and determines the cells' size in
// metres. Without such a name, origin, projection and cell size are not set. Errors: kMalformed
// (another size).
Result<StoredImage> parseHgt(std::string_view bytes, std::string_view name);
bool isHgt(std::string_view bytes, std::string_view name) noexcept;

// Parses an ESRI ASCII grid: ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize
// (or dx and dy), NODATA_value, then the heights. `projection`: the text of the .prj file in the
// same folder (WKT or ArcInfo's lines), or empty. Cells in degrees are converted to metres at the
// latitude of the map's middle. Whether cells are in degrees follows from the projection or, if
// that is empty, from the position of the corner and the cell size. The origin is the middle of the
// lower left cell. Errors, with the line or the value's number: kMalformed, kUnsupported (too many
// cells).
Result<StoredImage> parseEsriGrid(std::string_view text, std::string_view projection);
bool isEsriGrid(std::string_view text) noexcept;

}  // namespace merlin::render::range
