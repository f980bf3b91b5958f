#include "render/range/io/image_header.h"

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "render/range/io/words.h"

namespace merlin::render::range {
namespace {

struct ScannerName {
  Scanner scanner;
  const char* name;
};
constexpr ScannerName kScannerNames[] = {{Scanner::kOrthogonal, "orthogonal"},
                                         {Scanner::kSpinning, "spinning"},
                                         {Scanner::kPinhole, "pinhole"},
                                         {Scanner::kElevation, "elevation"},
                                         {Scanner::kRays, "rays"}};

using Numbers = std::vector<double>;

void setAngles(const Numbers& n, ImageHeader& header) {
  header.angles_deg = {n[0], n.size() > 1 ? n[1] : 0};
}
void addBeam(const Numbers& n, ImageHeader& header) {
  header.beams.push_back({n[0] * kDegree, n.size() > 1 ? n[1] * kDegree : 0});
}
void setCamera(const Numbers& n, ImageHeader& header) {
  header.camera.emplace();
  for (std::size_t i = 0; i < 12; ++i) (*header.camera)[i] = n[i];
}

// A key whose value is a list of numbers.
struct Key {
  const char* key;
  std::size_t least, most;  // minimum and maximum count of the numbers
  const char* allowed;
  void (*set)(const Numbers&, ImageHeader&);
};
constexpr Key kKeys[] = {
    {"angles", 1, 2, "one or two numbers (degrees: horizontal, vertical)", setAngles},
    {"beam", 1, 2, "one or two numbers (degrees: altitude, azimuth)", addBeam},
    {"minimum", 1, 1, "a number", [](const Numbers& n, ImageHeader& h) { h.minimum = n[0]; }},
    {"maximum", 1, 1, "a number", [](const Numbers& n, ImageHeader& h) { h.maximum = n[0]; }},
    {"scale", 1, 1, "a number (metres per unit)",
     [](const Numbers& n, ImageHeader& h) { h.scale = n[0]; }},
    {"no-return", 1, 1, "a number", [](const Numbers& n, ImageHeader& h) { h.no_return = n[0]; }},
    {"camera", 12, 12, "twelve numbers (three rows of rotation and translation)", setCamera},
    {"cell", 1, 2, "one or two numbers (distances of columns and of rows)",
     [](const Numbers& n, ImageHeader& h) {
       h.cell = {n[0], n.back()};
     }},
    {"origin", 2, 2, "two numbers (coordinates of the middle of the lower left pixel)",
     [](const Numbers& n, ImageHeader& h) {
       h.origin = {n[0], n[1]};
     }}};

Error keyFault(std::string_view key, std::string_view found, std::string_view allowed) {
  return {Errc::kMalformed,
          fmt::format("{}: found \"{}\", allowed: {}", key, oneLine(excerpt(found)), allowed)};
}

// Adds a feature file given as "NAME=FILE". The file must be in the same folder, since the header
// comes from an untrusted file.
Result<Ok> addFeature(std::string_view value, ImageHeader& header) {
  const std::size_t equals = value.find('=');
  const std::string_view name = value.substr(0, equals);
  const std::string_view file =
      equals == std::string_view::npos ? std::string_view() : value.substr(equals + 1);
  if (name.empty() || file.empty() || file.front() == '.' ||
      file.find('/') != std::string_view::npos)
    return keyFault("feature", value, "NAME=FILE, a file in the same folder");
  if (header.features.size() == kMostFeatures)
    return keyFault("feature", value, fmt::format("{} features", kMostFeatures));
  header.features.push_back({std::string(name), std::string(file)});
  return Ok{};
}

}  // namespace

const char* nameOf(Scanner scanner) {
  for (const ScannerName& row : kScannerNames) {
    if (row.scanner == scanner) return row.name;
  }
  return "";
}

std::optional<Scanner> scannerOf(std::string_view name) {
  for (const ScannerName& row : kScannerNames) {
    if (row.name == name && row.scanner != Scanner::kRays) return row.scanner;
  }
  return std::nullopt;
}

Result<Ok> applyLine(std::string_view line, ImageHeader& header) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return Ok{};
  const std::string key = lowerCase(trimmed(line.substr(0, colon)));
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (key == "geometry") {
    header.scanner = scannerOf(lowerCase(value));
    if (header.scanner) return Ok{};
    return keyFault(key, value, "orthogonal, spinning, pinhole, elevation");
  }
  if (key == "unit") {
    header.unit = excerpt(value);
    return Ok{};
  }
  if (key == "feature") return addFeature(value, header);
  if (key == "projection") {
    if (value.size() > kMostProjection || !isText(value))
      return keyFault(key, value, fmt::format("text of up to {} bytes", kMostProjection));
    header.projection = value;
    return Ok{};
  }
  for (const Key& known : kKeys) {
    if (key != known.key) continue;
    const Numbers numbers = numbersOf(value, known.most);
    if (numbers.size() < known.least) return keyFault(key, value, known.allowed);
    known.set(numbers, header);
    return Ok{};
  }
  return Ok{};
}

ImageHeader headerOf(const RangeImage& image) {
  const Geometry& g = image.geometry;
  ImageHeader header;
  header.scanner = g.scanner;
  if (g.scanner == Scanner::kElevation) {
    header.cell = {g.cell_x, g.cell_y};
    header.projection = g.projection;
    header.origin = g.origin;
    return header;
  }
  header.unit = image.unit;
  header.angles_deg = {g.horizontal_rad / kDegree, g.vertical_rad / kDegree};
  header.beams = g.beams;
  if (g.T_world_scanner != kIdentity) header.camera = g.T_world_scanner;
  return header;
}

std::string linesOf(const ImageHeader& header, std::string_view before) {
  std::string text;
  const auto add = [&](const char* key, const std::string& value) {
    text += fmt::format("{}{}: {}\n", before, key, value);
  };
  const auto addNumber = [&](const char* key, const std::optional<double>& value) {
    if (value) add(key, fmt::format("{}", *value));
  };
  if (header.scanner) add("geometry", nameOf(*header.scanner));
  if (header.angles_deg)
    add("angles", fmt::format("{} {}", (*header.angles_deg)[0], (*header.angles_deg)[1]));
  for (const Beam& beam : header.beams)
    add("beam", fmt::format("{} {}", beam.altitude_rad / kDegree, beam.azimuth_rad / kDegree));
  if (header.cell) add("cell", fmt::format("{} {}", (*header.cell)[0], (*header.cell)[1]));
  addNumber("minimum", header.minimum);
  addNumber("maximum", header.maximum);
  addNumber("scale", header.scale);
  addNumber("no-return", header.no_return);
  if (!header.unit.empty()) add("unit", header.unit);
  if (!header.projection.empty()) add("projection", header.projection);
  if (header.origin) add("origin", fmt::format("{} {}", (*header.origin)[0], (*header.origin)[1]));
  for (const FeatureFile& feature : header.features)
    add("feature", feature.name + "=" + feature.file);
  if (header.camera) {
    std::string numbers;
    for (const double x : *header.camera)
      numbers += fmt::format("{}{}", numbers.empty() ? "" : " ", x);
    add("camera", numbers);
  }
  return text;
}

}  // namespace merlin::render::range
