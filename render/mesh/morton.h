// Computes the Morton (Z-order) key of a point in a box; points with nearby keys are close in
// space. Source: G. M. Morton, "A computer oriented geodetic data base ...", IBM, 1966.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace merlin::render::mesh {

// Spreads the low 21 bits of `v`: inserts two zero bits between neighbouring bits.
inline std::uint64_t spreadBits(std::uint64_t v) {
  v = (v | v << 32) & 0x001F00000000FFFF;
  v = (v | v << 16) & 0x001F0000FF0000FF;
  v = (v | v << 8) & 0x100F00F00F00F00F;
  v = (v | v << 4) & 0x10C30C30C30C30C3;
  return (v | v << 2) & 0x1249249249249249;
}

// Returns the Morton key of a point (3 floats). It has 3 x `bits` bits: each axis of the box [low,
// low + extent] is divided into 2^bits steps. Points outside are clamped to the box. REQUIRES:
// extent > 0 on each axis, bits <= 21.
inline std::uint64_t mortonKey(const float* point, const std::array<float, 3>& low,
                               const std::array<float, 3>& extent, unsigned bits) {
  const auto steps = static_cast<float>((1U << bits) - 1);
  std::uint64_t key = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const float unit = std::clamp((point[k] - low[k]) / extent[k], 0.0F, 1.0F);
    key |= spreadBits(static_cast<std::uint64_t>(unit * steps)) << k;
  }
  return key;
}

}  // namespace merlin::render::mesh
