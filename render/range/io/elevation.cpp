#include "render/range/io/elevation.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/bytes.h"
#include "daemon/base/printable_text.h"
#include "render/range/io/words.h"

namespace merlin::render::range {
namespace {

// The latitude and longitude of the south-west corner that a name such as N44W072.hgt tells.
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

std::size_t sideOf(std::size_t bytes) {
  for (const std::size_t side : kTileSides) {
    if (bytes == 2 * side * side) return side;
  }
  return 0;
}

struct GridHeader {
  std::optional<double> columns, rows, west, south, cell, dx, dy, no_data;
};

// Reads a line of the header; false if its key is none.
bool readKey(const std::string& key, double value, GridHeader& header) {
  struct Key {
    const char* name;
    std::optional<double> GridHeader::*field;
  };
  constexpr Key kKeys[] = {
      {"ncols", &GridHeader::columns},   {"nrows", &GridHeader::rows},
      {"xllcorner", &GridHeader::west},  {"xllcenter", &GridHeader::west},
      {"yllcorner", &GridHeader::south}, {"yllcenter", &GridHeader::south},
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
    const bool read = readNumber(trimmed(value), number) && std::abs(number) <= 1e30;
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

bool isInDegrees(const GridHeader& header, double dx, std::string_view projection) {
  if (!projection.empty()) return projection.find("PROJC") == std::string_view::npos;
  return header.west && header.south && std::abs(*header.west) <= 360 &&
         std::abs(*header.south) <= 90 && dx < 0.1;
}

// The distances of columns and rows, in metres if they are in degrees.
void setCells(const GridHeader& header, std::string_view projection, StoredImage& image) {
  double dx = header.dx.value_or(header.cell.value_or(0));
  double dy = header.dy.value_or(header.cell.value_or(0));
  if (projection.size() <= kMostProjection / 4)  // an escaped byte takes four
    image.header.projection = oneLine(trimmed(projection));
  if (!projection.empty())
    image.notes.push_back(fmt::format("projection: {}", oneLine(excerpt(trimmed(projection)))));
  if (!isInDegrees(header, dx, projection)) {
    image.header.cell = {dx, dy};
    return;
  }
  const double middle = header.south.value_or(0) + dy * static_cast<double>(image.height) / 2;
  const auto metres = metresPerDegree(middle);
  image.notes.push_back(
      fmt::format("cells of {:.6g} x {:.6g} degrees are taken as {:.2f} x {:.2f} m, as at latitude "
                  "{:.3f}",
                  dx, dy, dx * metres[0], dy * metres[1], middle));
  image.header.cell = {dx * metres[0], dy * metres[1]};
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
    if (!readNumber(word, height))
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
