#include "render/range/io/angle_table.h"

#include <cmath>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "render/range/io/words.h"

namespace merlin::render::range {
namespace {

constexpr std::size_t kMostRows = 65536;

// Reads a comment "columns: 1024 over 360 deg", if it is one. Returns false if the comment has the
// key but not this form.
bool readColumns(std::string_view comment, std::size_t& columns, double& turn_deg) {
  constexpr std::string_view kKey = "columns:";
  const std::size_t at = comment.find(kKey);
  if (at == std::string_view::npos) return true;
  std::string_view rest = comment.substr(at + kKey.size());
  const bool counted = readNumber(takeWord(rest), columns) && columns > 0 && columns <= kMostPixels;
  if (!counted || takeWord(rest) != "over") return false;
  return readNumber(takeWord(rest), turn_deg) && turn_deg > 0 && turn_deg <= 360;
}

// Returns the numbers of a line as a beam; nothing if they are not valid for row `row`.
std::optional<Beam> beamOf(const std::vector<double>& n, std::size_t row) {
  if (n.empty()) return std::nullopt;
  if (n.size() < 3) return Beam{n[0] * kDegree, n.size() > 1 ? n[1] * kDegree : 0};
  if (n[0] != static_cast<double>(row)) return std::nullopt;
  return Beam{n[1] * kDegree, n[2] * kDegree};
}

}  // namespace

double leftOfShift(double azimuth_rad, double turn_rad, std::size_t columns) {
  const double step = turn_rad / static_cast<double>(columns);
  return azimuth_rad - std::round(azimuth_rad / step) * step;
}

Result<Ok> parseAngleTable(std::string_view text, ImageHeader& header) {
  std::vector<Beam> beams;
  std::size_t columns = 0;
  double turn_deg = header.angles_deg ? (*header.angles_deg)[0] : 360;
  bool shifted = false;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = takeLine(text);
    const std::size_t hash = line.find('#');
    if (hash != std::string_view::npos) {
      const std::string_view comment = line.substr(hash);
      shifted = shifted || comment.find("destagger") != std::string_view::npos;
      if (!readColumns(comment, columns, turn_deg))
        return Error{Errc::kMalformed,
                     fmt::format("line {}: \"{}\"; allowed: columns: NUMBER over DEGREES deg",
                                 number, oneLine(excerpt(comment)))};
    }
    const std::string_view words = trimmed(line.substr(0, hash));
    if (words.empty()) continue;
    const auto beam = beamOf(numbersOf(words, 3), beams.size());
    if (!beam || beams.size() == kMostRows)
      return Error{Errc::kMalformed,
                   fmt::format("line {}: \"{}\"; allowed: row {}, its altitude and its azimuth in "
                               "degrees, {} rows at most",
                               number, oneLine(excerpt(words)), beams.size(), kMostRows)};
    beams.push_back(*beam);
  }
  if (beams.empty()) return Error{Errc::kMalformed, "has no row of angles"};
  for (Beam& beam : beams) {
    if (shifted && columns > 0)
      beam.azimuth_rad = leftOfShift(beam.azimuth_rad, turn_deg * kDegree, columns);
  }
  header.scanner = Scanner::kSpinning;
  header.angles_deg = {turn_deg, 0};
  header.beams = std::move(beams);
  if (columns > 0) header.columns = columns;
  return Ok{};
}

}  // namespace merlin::render::range
