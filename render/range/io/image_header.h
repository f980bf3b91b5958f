// ImageHeader: the properties of pixels and scanner that a range file gives, before the command
// line overrides them. Their text form is lines "key: value", which PGM files contain as comments
// (README.md).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

// A registered image in a separate file: the name of the feature that it becomes, and the name of
// the file, which lies in the same folder as the range file.
struct FeatureFile {
  std::string name, file;
};

struct ImageHeader {
  std::optional<Scanner> scanner{};
  // Horizontal, vertical; if there are beams, only [0] is used.
  std::optional<std::array<double, 2>> angles_deg{};
  std::vector<Beam> beams{};  // rows of a spinning scanner, top row first
  // Number of columns for which `beams` was made.
  std::optional<std::size_t> columns{};
  // Range stored as 0; range stored as the largest value.
  std::optional<double> minimum{}, maximum{};
  std::optional<double> scale{};      // metres per unit of the values
  std::optional<double> no_return{};  // stored value of pixels without a return
  std::optional<Pose> camera{};       // T_world_scanner
  // Elevation map: width and height of a cell [units].
  std::optional<std::array<double, 2>> cell{};
  std::string unit{};
  // Elevation map: projection as one line of text (WKT)
  std::string projection{};
  std::optional<std::array<double, 2>> origin{};  // elevation map: see Geometry::origin
  std::vector<FeatureFile> features{};
};

// Returns the name of a scanner: "orthogonal", "spinning", "pinhole", "elevation" or "rays".
const char* nameOf(Scanner scanner);
// Inverse of nameOf(); nothing for kRays and unknown names.
std::optional<Scanner> scannerOf(std::string_view name);

inline constexpr std::size_t kMostFeatures = 64;  // limit of files that a header may name

inline constexpr std::size_t kMostProjection = 8192;  // limit of the projection text [bytes]

// If `line` is "key: value" with a key of the table in README.md, sets that field of the header;
// other lines are ignored. Errors: kMalformed, with the key, the value found and the allowed
// values.
Result<Ok> applyLine(std::string_view line, ImageHeader& header);

// Returns the header that describes the image's geometry in a file. REQUIRES: the geometry is not
// kRays.
ImageHeader headerOf(const RangeImage& image);

// Returns the header as lines that applyLine() can read back; each line begins with `before` and
// ends with a line feed.
std::string linesOf(const ImageHeader& header, std::string_view before);

}  // namespace merlin::render::range
