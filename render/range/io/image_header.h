// ImageHeader: what a range file says about its pixels and its scanner, before the command line
// overrides it; and its text form: "key: value" lines, which PGM files contain as comments
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

// A registered image in a file of its own: the name of the feature that it becomes, and the name of
// the file, which lies in the folder of the file that names it.
struct FeatureFile {
  std::string name, file;
};

struct ImageHeader {
  std::optional<Scanner> scanner{};
  std::optional<std::array<double, 2>> angles_deg{};  // horizontal, vertical; with beams only [0]
  std::vector<Beam> beams{};                          // of a spinning scanner, one per row
  std::optional<std::size_t> columns{};               // number for which `beams` is made
  std::optional<double> minimum{}, maximum{};         // ranges at the stored 0 and largest value
  std::optional<double> scale{};                      // metres per unit of the values
  std::optional<double> no_return{};                  // the stored value of pixels without a return
  std::optional<Pose> camera{};                       // T_world_scanner
  std::optional<std::array<double, 2>> cell{};        // elevation map: size of a cell [units]
  std::string unit{};
  std::string projection{};                       // of an elevation map: one line of text (WKT)
  std::optional<std::array<double, 2>> origin{};  // of an elevation map: Geometry::origin
  std::vector<FeatureFile> features{};
};

// "orthogonal", "spinning", "pinhole", "elevation"; for kRays "rays".
const char* nameOf(Scanner scanner);
std::optional<Scanner> scannerOf(std::string_view name);  // not kRays

inline constexpr std::size_t kMostFeatures = 64;  // files that a header may name

inline constexpr std::size_t kMostProjection = 8192;  // [bytes]

// Sets the field that the line names, if it is "key: value" with a key of the table in README.md;
// other lines are ignored. Errors: kMalformed, with the key, what was found and what is allowed.
Result<Ok> applyLine(std::string_view line, ImageHeader& header);

// Returns the header with which a file describes the image's geometry. REQUIRES: the geometry is
// not kRays.
ImageHeader headerOf(const RangeImage& image);

// The header as lines that applyLine() can read back, each preceded by `before` and ended by a line
// feed.
std::string linesOf(const ImageHeader& header, std::string_view before);

}  // namespace merlin::render::range
