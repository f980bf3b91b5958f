#include "render/correct/correct_pixels.h"

#include <algorithm>
#include <cstring>

#include "daemon/base/simd.h"
#include "render/correct/power.h"

namespace merlin::render::correct {
namespace {

using namespace simd;

struct Colour {
  Floats channel[3];
};

// Loads two neighbouring pixels at each of eight positions; returns the eight left and the eight
// right ones.
struct TwoPixels {
  Ints left, right;
};
MERLIN_INLINE TwoPixels pairsAt(const std::uint8_t* picture, const Ints& index) {
  using Pairs = Vector<std::uint64_t, 32>;
  const auto at = [&](int k) {
    std::uint64_t two;
    std::memcpy(&two, picture + std::ptrdiff_t{4} * index[k], sizeof two);
    return two;
  };
  const Ints a = reinterpret_cast<Ints>(Pairs{at(0), at(1), at(2), at(3)});
  const Ints b = reinterpret_cast<Ints>(Pairs{at(4), at(5), at(6), at(7)});
  return {__builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14),
          __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15)};
}

// Step 1 of the formula; values 0..255.
MERLIN_INLINE Colour filtered(const CorrectionMap& map, const std::uint8_t* picture,
                              std::size_t entry) {
  const Ints x = load(&map.source_x[entry]), y = load(&map.source_y[entry]);
  // The last column and row are only read as the second pixel of a pair, so nothing beyond is read.
  const Ints column = least(x >> 8, all(map.source_width - 2));
  const Ints row = least(y >> 8, all(map.source_height - 2));
  const Floats fx = toFloats(x - (column << 8)) * (1.0F / CorrectionMap::kOne);
  const Floats fy = toFloats(y - (row << 8)) * (1.0F / CorrectionMap::kOne);
  const Ints index = row * map.source_width + column;
  const TwoPixels upper = pairsAt(picture, index);
  const TwoPixels lower = pairsAt(picture + std::ptrdiff_t{4} * map.source_width, index);
  Colour colour{};
  for (int c = 0; c < 3; ++c) {
    const auto of = [&](const Ints& pixel) __attribute__((always_inline)) {
      return toFloats((pixel >> (8 * c)) & 255);
    };
    const Floats a = of(upper.left), b = of(lower.left);
    const Floats top = a + fx * (of(upper.right) - a), bottom = b + fx * (of(lower.right) - b);
    colour.channel[c] = top + fy * (bottom - top);
  }
  return colour;
}

// Steps 2 to 6 of the formula; values 0..255.
MERLIN_INLINE Colour corrected(const CorrectionMap& map, const Colour& in, std::size_t entry) {
  const Light& l = map.light;
  const Floats root = toFloats(load(&map.gain[entry])) * (1.0F / CorrectionMap::kFullShare);
  const Floats gain = root * root;
  const Floats black = toFloats(load(&map.black[entry])) * (1.0F / CorrectionMap::kFullShare);
  const Floats headroom = greatest(black, all(l.least_headroom));
  Floats light[3];
  for (int c = 0; c < 3; ++c) light[c] = power(in.channel[c] * (1.0F / 255), l.gamma);
  Colour out{};
  for (std::size_t c = 0; c < 3; ++c) {
    const float* m = &l.matrix[3 * c];
    const Floats mixed = greatest(m[0] * light[0] + m[1] * light[1] + m[2] * light[2], all(0.0F));
    const Floats lift = black * l.black[c];
    const Floats sum =
        least(mixed * l.gain[c], all(1.0F)) * gain * (1.0F - headroom * l.black[c]) + lift;
    out.channel[c] = power(least(sum, all(1.0F)), l.encode[c]) * 255.0F;
  }
  return out;
}

MERLIN_INLINE Ints packed(const Colour& colour) {
  Ints pixel = all(static_cast<std::int32_t>(0xFF000000U));
  for (int c = 0; c < 3; ++c) pixel |= toInts(colour.channel[c] + 0.5F) << (8 * c);
  return pixel;
}

MERLIN_INLINE void rows(const CorrectionMap& map, const std::uint8_t* picture, std::uint8_t* signal,
                        int first, int last) {
  for (int y = first; y < last; ++y) {
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(map.stride);
    std::uint8_t* const to =
        signal + std::size_t{4} * static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width);
    for (int x = 0; x < map.width; x += kRun) {
      const std::size_t entry = row + static_cast<std::size_t>(x);
      const RunKind kind = map.runs[entry / kRun];
      Ints pixels = all(static_cast<std::int32_t>(0xFF000000U));
      if (kind != RunKind::kNothing) {
        Colour colour = filtered(map, picture, entry);
        if (kind == RunKind::kLight) colour = corrected(map, colour, entry);
        pixels = packed(colour);
      }
      const auto count = static_cast<std::size_t>(std::min(kRun, map.width - x));
      if (count == kRun)
        std::memcpy(to + std::ptrdiff_t{4} * x, &pixels, sizeof pixels);
      else
        std::memcpy(to + std::ptrdiff_t{4} * x, &pixels, 4 * count);
    }
  }
}

void portableRows(const CorrectionMap& map, const std::uint8_t* picture, std::uint8_t* signal,
                  int first, int last) {
  rows(map, picture, signal, first, last);
}

MERLIN_WIDE void wideRows(const CorrectionMap& map, const std::uint8_t* picture,
                          std::uint8_t* signal, int first, int last) {
  rows(map, picture, signal, first, last);
}

}  // namespace

CorrectRows portableRowCorrector() { return portableRows; }

CorrectRows rowCorrector() { return pick(wideRows, portableRows); }

}  // namespace merlin::render::correct
