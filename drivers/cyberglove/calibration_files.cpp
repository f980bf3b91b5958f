#include "drivers/cyberglove/calibration_files.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace merlin::cyberglove {
namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180;
constexpr std::string_view kBlanks = " \t\r";

struct Line {
  int number;
  std::string_view text;
};

// Returns the lines that are not blank.
std::vector<Line> linesOf(std::string_view text) {
  std::vector<Line> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.find_first_not_of(kBlanks) != std::string_view::npos) lines.push_back({number, line});
  }
  return lines;
}

// Returns all numbers of a line; nothing if it contains anything but finite numbers and
// `separators`.
std::optional<std::vector<float>> numbersOf(std::string_view text, std::string_view separators) {
  std::vector<float> numbers;
  for (;;) {
    const auto first = text.find_first_not_of(separators);
    if (first == std::string_view::npos) return numbers;
    text.remove_prefix(first);
    const std::string_view word = text.substr(0, text.find_first_of(separators));
    float value = 0;
    const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
    if (parsed.ec != std::errc{} || parsed.ptr != word.data() + word.size()) return std::nullopt;
    if (!std::isfinite(value)) return std::nullopt;
    numbers.push_back(value);
    text.remove_prefix(word.size());
  }
}

Error errorAt(const std::string& where, const std::string& what) {
  return {Errc::kMalformed, fmt::format("{} {}", where, what)};
}

// Sets offset and gain of a slot by the straight line through two points.
Result<Ok> fit(ImportedCalibration& c, std::size_t slot, const GloveSpan& span,
               const std::string& where) {
  if (span.raw_a == span.raw_b)
    return errorAt(where, fmt::format("has two points with the same raw value, {}", span.raw_a));
  c.given[slot] = true;
  c.gain[slot] = span.gain();
  c.offset[slot] = span.gain() == 0 ? span.raw_a : span.offset();
  return Ok{};
}

Result<ImportedCalibration> readVendor(const std::vector<Line>& lines) {
  ImportedCalibration c{.format = "vendor's .cal"};
  std::size_t slot = 0;
  for (const Line& line : lines) {
    if (line.text.find("E_O_CAL") != std::string_view::npos) break;
    const auto numbers = numbersOf(line.text, kBlanks);
    if (!numbers || numbers->size() != 4) continue;  // a comment, or "FINGER n:"
    if (slot < 23) {
      c.given[slot] = true;
      c.offset[slot] = (*numbers)[1];
      c.gain[slot] = (*numbers)[2];
    }
    ++slot;
  }
  if (slot != 24) {
    return Error{Errc::kMalformed,
                 fmt::format("has {} lines of joints, where the vendor's .cal has 24", slot)};
  }
  return c;
}

// Line i of the file belongs to value kValue[i] of a 22-sensor glove's record.
Result<ImportedCalibration> readAsr(const std::vector<Line>& lines) {
  constexpr std::size_t kValue[] = {21, 20, 3, 0,  1,  2,  4,  10, 5,  6,  7,
                                    19, 8,  9, 11, 14, 12, 13, 15, 18, 16, 17};
  ImportedCalibration c{.format = "asr_cyberglove"};
  if (lines.size() != std::size(kValue)) {
    return Error{Errc::kMalformed,
                 fmt::format("has {} lines; a calibration of the program asr_cyberglove has 22",
                             lines.size())};
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string where = fmt::format("line {}", lines[i].number);
    const auto n = numbersOf(lines[i].text, " \t\r:");
    if (!n || n->size() != 4)
      return errorAt(where, "does not have the form \"angle:raw angle:raw\"");
    const std::size_t slot = kValue[i] < 7 ? kValue[i] : kValue[i] + 1;
    const bool palm_or_wrist = slot >= 20 || slot == 15 || slot == 19;
    const float sign = palm_or_wrist ? 1.0F : -1.0F;
    const GloveSpan span{(*n)[1], sign * (*n)[0], (*n)[3], sign * (*n)[2]};
    if (slot == 20 && span.rad_a == span.rad_b) continue;  // the file has no palm-arch angle
    if (auto done = fit(c, slot, span, where); !done) return done.error();
  }
  return c;
}

std::optional<std::size_t> shadowSlot(std::string_view name) {
  constexpr std::string_view kNames[] = {
      "G_ThumbRotate", "G_ThumbMPJ",   "G_ThumbIJ",   "G_ThumbAb",
      "G_IndexMPJ",    "G_IndexPIJ",   "G_IndexDIJ",  "",
      "G_MiddleMPJ",   "G_MiddlePIJ",  "G_MiddleDIJ", "G_MiddleIndexAb",
      "G_RingMPJ",     "G_RingPIJ",    "G_RingDIJ",   "G_RingMiddleAb",
      "G_PinkieMPJ",   "G_PinkiePIJ",  "G_PinkieDIJ", "G_PinkieRingAb",
      "G_PalmArch",    "G_WristPitch", "G_WristYaw"};
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    if (!name.empty() && kNames[i] == name) return i;
  }
  return std::nullopt;
}

// Each joint's name is followed by pairs of a raw value (0..1) and an angle in degrees. Uses the
// straight line through the first and the last pair.
Result<ImportedCalibration> readShadow(std::string_view text, const char* format) {
  ImportedCalibration c{.format = format};
  for (std::size_t at = text.find("\"G_"); at != std::string_view::npos;) {
    const std::size_t next = text.find("\"G_", at + 1);
    std::string_view part = text.substr(at + 1, next - at - 1);
    const std::string name(part.substr(0, part.find('"')));
    part.remove_prefix(std::min(name.size() + 1, part.size()));
    at = next;
    const auto slot = shadowSlot(name);
    if (!slot) return errorAt(name, "is not a joint of a CyberGlove");
    std::string plain;
    for (const char ch : part) {
      const bool number = (ch >= '0' && ch <= '9') || ch == '.' || ch == '-';
      plain += number ? ch : ' ';
    }
    const auto n = numbersOf(plain, " ");
    if (!n || n->size() < 4 || n->size() % 2 != 0)
      return errorAt(name, "needs two points or more, each a raw value and an angle in degrees");
    const auto raw = [&](std::size_t i) { return 1 + 254 * (*n)[i]; };
    const std::size_t last = n->size() - 2;
    const GloveSpan span{raw(0), kDegree * (*n)[1], raw(last), kDegree * (*n)[last + 1]};
    if (auto done = fit(c, *slot, span, name); !done) return done.error();
  }
  return c;
}

Result<ImportedCalibration> readVess(const std::vector<Line>& lines) {
  // Angle between the minimum and the maximum of each slot's sensor [degrees].
  constexpr float kRange[] = {90, 45,  70, 30, 90, 100, 70, 30, 90, 100, 70, 30,
                              90, 100, 70, 30, 90, 100, 70, 45, 45, 90,  45};
  ImportedCalibration c{.format = "VESS"};
  if (lines.size() != std::size(kRange)) {
    return Error{Errc::kMalformed, fmt::format("has {} lines, where VESS's has 23", lines.size())};
  }
  for (std::size_t slot = 0; slot < lines.size(); ++slot) {
    const std::string where = fmt::format("line {}", lines[slot].number);
    const auto n = numbersOf(lines[slot].text, kBlanks);
    if (!n || n->size() != 3) return errorAt(where, "does not have the form \"idle min max\"");
    const float idle = (*n)[0], low = (*n)[1], high = (*n)[2];
    if (low >= high) {
      return errorAt(
          where,
          fmt::format("has a minimum of {} and a maximum of {}: are they swapped?", low, high));
    }
    c.given[slot] = true;
    c.offset[slot] = idle;
    c.gain[slot] = kDegree * kRange[slot] / (high - low);
  }
  return c;
}

}  // namespace

Result<ImportedCalibration> importCalibration(std::string_view text) {
  if (text.find("GLOVE CALIBRATION") != std::string_view::npos) return readVendor(linesOf(text));
  if (text.find("<Joint") != std::string_view::npos) return readShadow(text, "Shadow XML");
  if (text.find("\"G_") != std::string_view::npos) return readShadow(text, "Shadow YAML");
  const std::vector<Line> lines = linesOf(text);
  if (!lines.empty() && lines[0].text.find(':') != std::string_view::npos) return readAsr(lines);
  if (!lines.empty() && numbersOf(lines[0].text, kBlanks)) return readVess(lines);
  return Error{
      Errc::kMalformed,
      "is not in a known calibration format; known are the vendor's .cal, asr_cyberglove's, "
      "Shadow's XML and YAML, and VESS's"};
}

}  // namespace merlin::cyberglove
