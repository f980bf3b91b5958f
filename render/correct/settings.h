// Settings of an output's correction: warp, blend, colour and black level.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"

namespace merlin::render::correct {

// How a warp is interpolated between the points of its mesh. In the order of
// kMeshInterpolationNames.
enum class MeshInterpolation { kBicubic, kBilinear };
inline constexpr const char* kMeshInterpolationNames[] = {"bicubic", "bilinear"};

// Position on the output of a point of the uncorrected picture, as a share of the output's width
// and height from its upper left corner.
struct MeshPoint {
  double x = 0, y = 0;
  bool operator==(const MeshPoint&) const = default;
};

// A grid of points, equally spaced in the uncorrected picture; the outermost ones are on its
// border.
struct MeshSettings {
  int columns = 0, rows = 0;        // 0 and 0: no mesh
  std::vector<MeshPoint> points{};  // row by row from the top, columns * rows
  MeshInterpolation interpolation = MeshInterpolation::kBicubic;

  bool isOff() const { return columns == 0 && rows == 0 && points.empty(); }
  bool operator==(const MeshSettings&) const = default;
};

// Widths of the strips of the uncorrected picture that a neighbour shows too [px of that picture].
// In a strip the light decreases towards the border, so that both outputs' light adds up to the
// picture's.
struct BlendSettings {
  double left = 0, right = 0, top = 0, bottom = 0;
  double gamma = 2.2;  // the display's: light = signal ^ gamma
  // True: the strips are computed from the screens' positions, see out/room_blend.h.
  bool automatic = false;

  bool hasRamp() const { return left > 0 || right > 0 || top > 0 || bottom > 0; }
  bool operator==(const BlendSettings&) const = default;
};

struct ColourSettings {
  std::array<double, 9> matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};  // on linear light, row by row
  std::array<double, 3> gain{1, 1, 1};                      // on linear light: red, green, blue
  // Factor on blend.gamma for each channel; above 1, the channel becomes brighter.
  std::array<double, 3> gamma{1, 1, 1};

  bool isOff() const;
  bool operator==(const ColourSettings&) const = default;
};

struct BlackSettings {
  // Linear light that is added where no neighbour overlaps: red, green, blue; 1 is full brightness.
  std::array<double, 3> level{};

  bool isOff() const { return level == std::array<double, 3>{}; }
  bool operator==(const BlackSettings&) const = default;
};

struct CorrectionSettings {
  // Offsets of the picture's upper left, upper right, lower left and lower right corner from the
  // output's corners: x to the right, then y down, for each [px].
  std::array<double, 8> corners{};
  MeshSettings mesh{};
  std::string mpcdi{};         // file with a measured warp and blend, instead of mesh and blend
  std::string mpcdi_region{};  // id of the file's region to use; empty: the only one
  BlendSettings blend{};
  ColourSettings colour{};
  BlackSettings black{};

  // Returns whether the settings correct nothing, so that the output is sent the uncorrected
  // picture.
  bool isOff() const;
  bool operator==(const CorrectionSettings&) const = default;
};

// Moves a corner, counted as in `corners`, by pixels of the output.
void moveCorner(CorrectionSettings& settings, std::size_t corner, double right_px, double down_px);
// Moves a point of the mesh, counted from 0, by shares of the output's width and height. REQUIRES:
// the mesh has that point.
void moveMeshPoint(MeshSettings& mesh, int column, int row, const MeshPoint& by);

// A signal with several pictures of equal size (those of both eyes), each of which the projector
// stretches over the whole screen.
struct SignalParts {
  int columns = 1, rows = 1;
  bool operator==(const SignalParts&) const = default;
};

// Limits of the values; the configuration schema has the same ones.
inline constexpr double kMostCornerOffset = 16384;  // [px]
inline constexpr int kMostMeshSide = 64;            // points
inline constexpr double kLeastMeshPlace = -0.5, kMostMeshPlace = 1.5;
inline constexpr double kLeastGamma = 1, kMostGamma = 4;
inline constexpr double kLeastChannelGamma = 0.25, kMostChannelGamma = 4;
inline constexpr double kMostColour = 4;  // magnitude of the elements of the matrix and of the gain
inline constexpr double kMostBlack = 0.5;

// Checks for: values out of range or not numbers; corners that do not form a convex quadrilateral
// or mirror the picture; a mesh of less than 2 x 2 points, with a wrong number of points, or that
// folds; ramps that together are wider than the picture of width x height pixels; a black level
// without a ramp that defines the overlaps; a mesh, ramps or a black level together with an MPCDI
// file, which contains its own. Pure; takes some milliseconds if there is a mesh.
SettingFaults validate(const CorrectionSettings& settings, int width, int height);

}  // namespace merlin::render::correct
