// Reads the projection of a LAS file from its variable length records: WKT, or the keys of GeoTIFF.
// Format: ASPRS, "LAS Specification 1.4 - R15", 2019, chapter 3; OGC 19-008, "GeoTIFF Standard",
// 2019, section 7. Private to render/points/io.
#pragma once

#include <string>
#include <string_view>

namespace merlin::render::points {

struct LasProjection {
  // WKT, or from GeoTIFF keys: EPSG:N, EPSG:N+M (with heights), or a plain name; empty: unknown.
  std::string text;
  std::string note;  // note for the user if there is a record but no usable text; else empty
};

// Returns the projection of a LAS file. `bytes` is a whole file with a header of at least 227 bytes
// (375 in version 1.4); truncated records are ignored.
LasProjection lasProjection(std::string_view bytes);

}  // namespace merlin::render::points
