// Which values of a scientific picture become black and white: floats, and integers that are no
// colours, have a range of their own. Only the program merlin-import links this, behind its
// sandbox.
#pragma once

#include <functional>
#include <optional>

#include <vips/vips.h>

namespace merlin::render::import {

struct ValueRange {
  double low = 0, high = 1;  // black and white; low < high
};

// Whether the picture's numbers are not colours as its format has them: any but 8 and 16 bits
// without a sign and high-dynamic-range colours.
bool isMeasured(const VipsImage* image) noexcept;

// Grey of 16 bits that ends below this is taken for measured: cameras of heat and depth store 12 or
// 14 bits of 16, which would be nearly black.
inline constexpr double kMostOfDarkGrey = 16384;
bool isGrey16(const VipsImage* image) noexcept;

// The range of all values but the lowest and the highest thousandth, of up to 10^6 pixels that are
// spread evenly; values that are no numbers are left out. Nothing if there are no others, or the
// picture cannot be read (libvips has the reason). Reads the picture once from top to bottom.
// `on_share` is called with the part that is read, 0..1.
std::optional<ValueRange> rangeOf(VipsImage* image, const std::function<void(double)>& on_share);

// A new image of one or three bands of 8 bits: the range as 0 to 255, what lies outside at its
// ends, values that are no numbers as 0. Bands beyond the third are left out, and the second of
// two. Returns 0, or what functions of libvips return at a failure.
int stretch(VipsImage* image, const ValueRange& range, VipsImage** made);

}  // namespace merlin::render::import
