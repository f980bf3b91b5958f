// Elevation maps: tiles of the Shuttle Radar Topography Mission (HGT) and ESRI ASCII grids.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "render/range/io/stored_image.h"

namespace merlin::render::range {

// Lengths of a degree of longitude and of latitude at this latitude, on the ellipsoid WGS 84
// [metres].
std::array<double, 2> metresPerDegree(double latitude_deg);

// A tile of 1201 x 1201 or 3601 x 3601 heights, big-endian 16 bits, void where -32768; `name` is
// the file's, whose beginning (N44W072) says where it lies: the origin, in EPSG:4326, which becomes
// the projection. Errors: kMalformed (another size); without such a name the cells are left to the
// caller.
Result<StoredImage> parseHgt(std::string_view bytes, std::string_view name);
bool isHgt(std::string_view bytes, std::string_view name) noexcept;

// ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize (or dx and dy),
// NODATA_value, then the heights. `projection`: the text of the .prj file beside it (WKT or
// ArcInfo's lines), or empty; cells in degrees, which it or, where it is empty, the corner and the
// cells tell, become metres at the map's middle. The origin is the middle of the lower left cell.
// Errors, with the line or the value's number: kMalformed, kUnsupported (too many cells).
Result<StoredImage> parseEsriGrid(std::string_view text, std::string_view projection);
bool isEsriGrid(std::string_view text) noexcept;

}  // namespace merlin::render::range
