// CorrectionMap: tables, computed once, of what a correction does to each pixel of an output. The
// formula below is the reference. correct_pixels evaluates it on the CPU. gpu/shader_pass reads the
// same tables as textures; its results differ by at most 1 of 255.
//
// For the output's pixel p, with source position (X, Y), gain a and black share s from the tables:
//   1. c = bilinear filter of the uncorrected picture's signal (0..1) between the centres of the
//      four pixels around (X, Y)
//   2. L = c ^ gamma                                   linear light of each channel
//   3. L = max(0, matrix * L)
//   4. L = L * gain                                    each channel
//   5. L = min(1, L) * a * (1 - h * black) + s * black
//   6. signal = min(1, L) ^ encode                     encode = 1 / (gamma * channel's gamma)
// In step 5, h = max(s, least_headroom). With a measured beta map least_headroom is 0, so that h =
// s ([MPCDI] 2.4). With ramps it is 1: the range above black is then the same inside and outside an
// overlap. Where the light does not change (a = 1, h * black = 0, neutral colour), signal = c, and
// steps 2 to 6 may be skipped. The signal is rounded to the nearest of 0..255; alpha is 255.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/base/blocks.h"
#include "render/correct/settings.h"
#include "render/correct/warp.h"

namespace merlin::render::correct {

// A raster of any size over the whole output, with a share per cell: an alpha or a beta map
// [MPCDI].
struct MeasuredShares {
  int columns = 0, rows = 0;
  std::vector<float> shares{};  // 0..1, linear light, row by row from the top
};

// Measured data of an output: the content of one region of an MPCDI file.
struct MeasuredCorrection {
  MeasuredWarp warp{};
  std::optional<MeasuredShares> alpha{}, beta{};
  std::array<double, 3> beta_level{1, 1, 1};  // each channel's light at a beta share of 1
  int width = 0, height = 0;  // of the output that it was measured for [px]; 0: not known
};

// Constants of the formula.
struct Light {
  float gamma = 2.2F;
  std::array<float, 9> matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<float, 3> gain{1, 1, 1}, encode{1 / 2.2F, 1 / 2.2F, 1 / 2.2F}, black{};
  float least_headroom = 0;
};

// The output's pixels are processed in runs of this many; RunKind says which steps a run needs.
inline constexpr int kRun = 8;
enum class RunKind : std::uint8_t {
  kNothing,   // no pixel shows the picture: all are black
  kGeometry,  // only step 1
  kLight,     // all steps
};

// Tables of width x height pixels, row by row from the top. A row has `stride` entries, a multiple
// of kRun; the entries after the first `width` show nothing.
struct CorrectionMap {
  static constexpr int kOne = 256;          // one pixel, in units of source_x and source_y
  static constexpr int kFullShare = 65535;  // a share of 1, in units of gain and black

  int width = 0, height = 0, stride = 0;         // of the output [px]
  int source_width = 0, source_height = 0;       // of the uncorrected picture [px], each >= 2
  std::vector<std::int32_t> source_x, source_y;  // in 1 / kOne pixels; 0: centre of the first pixel
  // `gain` holds sqrt(a): stored linearly, a step of 1 / 65535 near 0 would be three steps of an
  // 8-bit signal with gamma 2.4.
  std::vector<std::uint16_t> gain, black;
  std::vector<RunKind> runs;  // stride / kRun per row
  Light light;
};

// For each pixel of an output: gain (alpha) and black (beta), in linear light; 0 if the pixel shows
// no point of the picture.
struct Shares {
  std::vector<float> gain, black;
};

// Computes the shares of an output of width x height pixels, from the ramps or, if `measured` is
// not null, from its maps.
Shares sharesOf(const CorrectionSettings& settings, int width, int height,
                std::span<const Place> places, const MeasuredCorrection* measured);

// Computes the map of an output of the picture's size, width x height pixels. `measured`: the data
// from the file settings.mpcdi; null without such a file. With several `parts`, the whole
// correction is applied to each of them; the settings' pixels are those of a signal with one
// picture. REQUIRES: validate() found no fault; the parts fill the signal. Takes about 0.5 s for
// 1280 x 960 pixels on one CPU core with a mesh, and 0.05 s without.
CorrectionMap makeCorrectionMap(const CorrectionSettings& settings, int width, int height,
                                const MeasuredCorrection* measured, Threads threads,
                                SignalParts parts = {});

}  // namespace merlin::render::correct
