#include "render/range/map_origin.h"

#include <cmath>
#include <cstddef>
#include <string>

#include "daemon/base/words.h"

namespace merlin::render::range {
namespace {

// Returns whether a key of WKT, in lower case, is the unit of a projection's own coordinates. Units
// at a greater depth belong to its parameters and to its base system.
bool isOwnUnit(std::string_view key, int depth) {
  return (key == "unit" && depth == 2) || (key == "lengthunit" && depth <= 3);
}

// Returns the number after a name in quotes, e.g. 0.3048 for "\"foot\",0.3048]"; 0 if there is
// none.
double numberBehindName(std::string_view text) {
  const std::size_t name = text.find('"');
  const std::size_t end = name == std::string_view::npos ? name : text.find('"', name + 1);
  const std::size_t comma = end == std::string_view::npos ? end : text.find(',', end);
  if (comma == std::string_view::npos) return 0;
  text.remove_prefix(comma + 1);
  double number = 0;
  return readNumber(trimmed(text.substr(0, text.find_first_of(",]"))), number) ? number : 0;
}

// Returns the length in metres of the unit of projected coordinates in WKT (in lower case); 0 if
// the text does not give it.
double metresInWkt(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  std::size_t word = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (quoted || (text[i] != '[' && text[i] != ']' && text[i] != ',')) continue;
    if (text[i] == ']' && --depth == 0) return 0;
    if (text[i] == '[' && isOwnUnit(trimmed(text.substr(word, i - word)), ++depth))
      return numberBehindName(text.substr(i + 1));
    word = i + 1;
  }
  return 0;
}

// Returns whether words such as "projection utm zone 33 units meters", in lower case, name metres
// as the unit.
bool saysMetres(std::string_view words) {
  for (std::string_view word = takeWord(words); !word.empty(); word = takeWord(words)) {
    if (word != "units") continue;
    const std::string_view unit = takeWord(words);
    return unit == "meters" || unit == "metres";
  }
  return false;
}

}  // namespace

bool isInMetres(std::string_view projection) {
  const std::string text = lowerCase(projection);
  const std::size_t wkt = text.find("projc");  // also if it is nested in a system with heights
  return wkt == std::string::npos ? saysMetres(text)
                                  : metresInWkt(std::string_view(text).substr(wkt)) == 1;
}

mesh::Origin mapOrigin(const Geometry& geometry) {
  if (geometry.scanner != Scanner::kElevation || !geometry.origin) return {};
  const auto [east, north] = *geometry.origin;
  const bool large = std::abs(east) > 360 || std::abs(north) > 90;
  const bool same = geometry.projection.empty() ? large : isInMetres(geometry.projection);
  return same && std::isfinite(east) && std::isfinite(north) ? mesh::Origin{east, north, 0}
                                                             : mesh::Origin{};
}

}  // namespace merlin::render::range
