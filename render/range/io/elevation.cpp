#include "render/range/io/elevation.h"

#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/bytes.h"
#include "daemon/base/printable_text.h"
#include "render/range/io/words.h"

namespace merlin::render::range {
namespace {

// The latitude and longitude of a tile's south-west corner, as given by a name such as N44W072.hgt.
struct Corner {
  double latitude_deg = 0, longitude_deg = 0;
};
std::optional<Corner> cornerOf(std::string_view name) {
  unsigned latitude = 0, longitude = 0;
  if (name.size() < 7 || !readNumber(name.substr(1, 2), latitude) ||
      !readNumber(name.substr(4, 3), longitude) || latitude > 90 || longitude > 180)
    return std::nullopt;
  const std::string letters = lowerCase(name.substr(0, 4));
  const bool south = letters[0] == 's', west = letters[3] == 'w';
  if ((letters[0] != 'n' && !south) || (letters[3] != 'e' && !west)) return std::nullopt;
  return Corner{south ? -1.0 * latitude : latitude, west ? -1.0 * longitude : longitude};
}

constexpr std::size_t kTileSides[] = {1201, 3601};

// EPSG:4326, the coordinate system of the tiles' corners. `origin` has the longitude first.
constexpr const char* kWgs84 =
    "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563,"
    "AUTHORITY[\"EPSG\",\"7030\"]],AUTHORITY[\"EPSG\",\"6326\"]],"
    "PRIMEM[\"Greenwich\",0,AUTHORITY[\"EPSG\",\"8901\"]],"
    "UNIT[\"degree\",0.0174532925199433,AUTHORITY[\"EPSG\",\"9122\"]],"
    "AXIS[\"Latitude\",NORTH],AXIS[\"Longitude\",EAST],AUTHORITY[\"EPSG\",\"4326\"]]";

std::size_t sideOf(std::size_t bytes) {
  for (const std::size_t side : kTileSides) {
    if (bytes == 2 * side * side) return side;
  }
  return 0;
}

struct GridHeader {
  std::optional<double> columns, rows, west, south, cell, dx, dy, no_data;
  // Middle of the lower left cell, instead of its corner.
  std::optional<double> west_middle, south_middle;
};

// Sets the field of the header that `key` names; returns false if the key is unknown.
bool readKey(const std::string& key, double value, GridHeader& header) {
  struct Key {
    const char* name;
    std::optional<double> GridHeader::*field;
  };
  constexpr Key kKeys[] = {
      {"ncols", &GridHeader::columns},   {"nrows", &GridHeader::rows},
      {"xllcorner", &GridHeader::west},  {"xllcenter", &GridHeader::west_middle},
      {"yllcorner", &GridHeader::south}, {"yllcenter", &GridHeader::south_middle},
      {"cellsize", &GridHeader::cell},   {"dx", &GridHeader::dx},
      {"dy", &GridHeader::dy},           {"nodata_value", &GridHeader::no_data}};
  for (const Key& row : kKeys) {
    if (key != row.name) continue;
    header.*row.field = value;
    return true;
  }
  return false;
}

Result<GridHeader> readGridHeader(std::string_view& text) {
  GridHeader header;
  for (std::size_t line = 1;; ++line) {
    std::string_view rest = text;
    const std::string_view words = trimmed(takeLine(rest));
    std::string_view value = words;
    const std::string key = lowerCase(takeWord(value));
    double number = 0;
    if (key.empty() || key[0] < 'a' || key[0] > 'z' || key == "nan") return header;
    // The value that marks voids may be any number, often one that no height can have, such as the
    // lowest float.
    const bool read =
        readNumber(trimmed(value), number) && (key == "nodata_value" || std::abs(number) <= 1e30);
    if (!read || !readKey(key, number, header))
      return Error{Errc::kMalformed,
                   fmt::format("line {}: \"{}\"; allowed: ncols, nrows, xllcorner, xllcenter, "
                               "yllcorner, yllcenter, cellsize, dx, dy, NODATA_value and a number",
                               line, oneLine(excerpt(words)))};
    text = rest;
  }
}

Result<std::size_t> countOf(const char* key, const std::optional<double>& value) {
  if (value && *value >= 1 && *value <= static_cast<double>(kMostPixels) &&
      *value == std::floor(*value))
    return static_cast<std::size_t>(*value);
  return Error{Errc::kMalformed,
               value ? fmt::format("{} is {}; allowed are 1 to {}", key, *value, kMostPixels)
                     : fmt::format("{} is missing", key)};
}

// Returns whether the text of a .prj file declares degrees: WKT, or ArcInfo's lines such as "Units
// DD".
bool saysDegrees(std::string_view projection) {
  const std::string text = lowerCase(projection);
  // The WKT of a projected system contains a geographic one, so it is tested first.
  if (text.find("projc") != std::string::npos) return false;
  if (text.find("geogcs") != std::string::npos || text.find("geogcrs") != std::string::npos)
    return true;
  for (std::string_view rest = text; !rest.empty();) {
    std::string_view line = takeLine(rest);
    const std::string_view key = takeWord(line), value = trimmed(line);
    if ((key == "projection" && value == "geographic") || (key == "units" && value == "dd"))
      return true;
  }
  return false;
}

// Returns a coordinate of the middle of the lower left cell; nothing if the header lacks it.
std::optional<double> middleOf(const std::optional<double>& corner,
                               const std::optional<double>& middle, double cell) {
  return corner ? *corner + cell / 2 : middle;
}

using Origin = std::optional<std::array<double, 2>>;
Origin originOf(const GridHeader& header, double dx, double dy) {
  const auto east = middleOf(header.west, header.west_middle, dx);
  const auto north = middleOf(header.south, header.south_middle, dy);
  if (!east || !north) return std::nullopt;
  return std::array{*east, *north};
}

bool isInDegrees(const Origin& origin, double dx, std::string_view projection) {
  if (!trimmed(projection).empty()) return saysDegrees(projection);
  return origin && std::abs((*origin)[0]) <= 360 && std::abs((*origin)[1]) <= 90 && dx < 0.1;
}

// Returns the words of a .prj file, separated by one blank.
std::string inOneLine(std::string_view text) {
  std::string line;
  for (std::string_view word = takeWord(text); !word.empty(); word = takeWord(text))
    line.append(line.empty() ? "" : " ").append(word);
  return line;
}

// Sets the cell size, i.e. the distances of columns and rows; converts degrees to metres. Also sets
// projection and origin.
void setCells(const GridHeader& header, std::string_view projection, StoredImage& image) {
  double dx = header.dx.value_or(header.cell.value_or(0));
  double dy = header.dy.value_or(header.cell.value_or(0));
  const std::string line = inOneLine(projection);
  if (line.size() <= kMostProjection / 4)  // oneLine() may write a byte as four
    image.header.projection = oneLine(line);
  if (!line.empty()) image.notes.push_back(fmt::format("projection: {}", oneLine(excerpt(line))));
  image.header.origin = originOf(header, dx, dy);
  if (!isInDegrees(image.header.origin, dx, projection)) {
    image.header.cell = {dx, dy};
    return;
  }
  const double south = image.header.origin ? (*image.header.origin)[1] : 0;
  const double middle = south + dy * static_cast<double>(image.height - 1) / 2;
  const auto metres = metresPerDegree(middle);
  image.notes.push_back(
      fmt::format("cells of {:.6g} x {:.6g} degrees are taken as {:.2f} x {:.2f} m, as at latitude "
                  "{:.3f}",
                  dx, dy, dx * metres[0], dy * metres[1], middle));
  image.header.cell = {dx * metres[0], dy * metres[1]};
}

// Reads a number as a float. A number beyond the range of floats, such as a void written as a
// double, becomes infinite; one that is too small becomes 0.
bool readFloat(std::string_view word, float& value) {
  if (readNumber(word, value)) return true;
  double wide = 0;
  if (!readNumber(word, wide)) return false;
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  value = std::abs(wide) < 1 ? 0 : wide > 0 ? kInfinite : -kInfinite;
  return true;
}

Result<Ok> readHeights(std::string_view text, StoredImage& image) {
  const std::size_t n = image.width * image.height;
  if (text.size() / 2 + 1 < n)
    return Error{Errc::kMalformed, fmt::format("has {} bytes of heights; {} x {} take {} at least",
                                               text.size(), image.width, image.height, 2 * n - 1)};
  image.values.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::string_view word = takeWord(text);
    float height = 0;
    if (!readFloat(word, height))
      return Error{Errc::kMalformed,
                   word.empty()
                       ? fmt::format("ends after {} of {} heights", i, n)
                       : fmt::format("row {}, column {}: \"{}\" is not a height", i / image.width,
                                     i % image.width, oneLine(excerpt(word)))};
    image.values.push_back(height);
  }
  if (!trimmed(text).empty()) image.notes.emplace_back("what follows the heights is ignored");
  return Ok{};
}

}  // namespace

std::array<double, 2> metresPerDegree(double latitude_deg) {
  constexpr double kRadius = 6378137, kFlattening = 1 / 298.257223563;  // WGS 84
  constexpr double kSquaredEccentricity = kFlattening * (2 - kFlattening);
  const double sin = std::sin(latitude_deg * kDegree), cos = std::cos(latitude_deg * kDegree);
  const double w = std::sqrt(1 - kSquaredEccentricity * sin * sin);
  return {kDegree * kRadius * cos / w,
          kDegree * kRadius * (1 - kSquaredEccentricity) / (w * w * w)};
}

bool isHgt(std::string_view bytes, std::string_view name) noexcept {
  return lowerCase(name).ends_with(".hgt") ||
         (sideOf(bytes.size()) > 0 && cornerOf(name).has_value());
}

Result<StoredImage> parseHgt(std::string_view bytes, std::string_view name) {
  const std::size_t side = sideOf(bytes.size());
  if (side == 0)
    return Error{Errc::kMalformed,
                 fmt::format("has {} bytes; a tile of heights has {} (1201 x 1201) or {} (3601 x "
                             "3601)",
                             bytes.size(), 2 * 1201 * 1201, 2 * 3601 * 3601)};
  StoredImage image;
  image.width = image.height = side;
  image.header.scanner = Scanner::kElevation;
  image.header.no_return = -32768;
  image.header.unit = "m";
  image.values.resize(side * side);
  const auto* p = reinterpret_cast<const std::uint8_t*>(bytes.data());
  for (std::size_t i = 0; i < image.values.size(); ++i)
    image.values[i] = static_cast<std::int16_t>(loadBe16(p + 2 * i));
  if (const auto corner = cornerOf(name)) {
    const auto metres = metresPerDegree(corner->latitude_deg + 0.5);
    const double cells = static_cast<double>(side - 1);
    image.header.cell = {metres[0] / cells, metres[1] / cells};
    image.header.origin = {corner->longitude_deg, corner->latitude_deg};
    image.header.projection = kWgs84;
    image.notes.push_back(
        fmt::format("cells of {:.0f} arc seconds are taken as {:.2f} x {:.2f} m, as at latitude "
                    "{}; WGS 84, south-west corner {}, {}",
                    3600 / cells, metres[0] / cells, metres[1] / cells, corner->latitude_deg + 0.5,
                    corner->latitude_deg, corner->longitude_deg));
  }
  return image;
}

bool isEsriGrid(std::string_view text) noexcept { return lowerCase(text.substr(0, 5)) == "ncols"; }

Result<StoredImage> parseEsriGrid(std::string_view text, std::string_view projection) {
  const auto header = readGridHeader(text);
  if (!header) return header.error();
  const auto columns = countOf("ncols", header->columns), rows = countOf("nrows", header->rows);
  if (!columns) return columns.error();
  if (!rows) return rows.error();
  if (*rows > kMostPixels / *columns)
    return Error{Errc::kUnsupported,
                 fmt::format("{} x {} heights; allowed are {}", *columns, *rows, kMostPixels)};
  if (!header->cell && !(header->dx && header->dy))
    return Error{Errc::kMalformed, "cellsize is missing"};
  StoredImage image;
  image.width = *columns;
  image.height = *rows;
  image.header.scanner = Scanner::kElevation;
  image.header.no_return = header->no_data.value_or(-9999);
  if (const auto read = readHeights(text, image); !read) return read.error();
  setCells(*header, projection, image);
  return image;
}

}  // namespace merlin::render::range
