// The projection of a LAS file, from its variable length records: WKT, or the keys of GeoTIFF.
// Format: ASPRS, "LAS Specification 1.4 - R15", 2019, chapter 3; OGC 19-008, "GeoTIFF Standard",
// 2019, section 7. Private to render/points/io.
#pragma once

#include <string>
#include <string_view>

namespace merlin::render::points {

struct LasProjection {
  std::string text;  // WKT; or EPSG:N of the keys, EPSG:N+M with heights; or the keys' own name
  std::string note;  // for the user, where there is a record that gives no text; else empty
};

// `bytes` is a whole file with a header of at least 227 bytes (375 of version 1.4); records that
// are cut count for nothing.
LasProjection lasProjection(std::string_view bytes);

}  // namespace merlin::render::points
