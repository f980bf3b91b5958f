// Determines which values of a scientific image are displayed as black and white: floats, and
// integers that are not colours, have no standard range. Linked only into the program
// merlin-import, which runs it in its sandbox.
#pragma once

#include <functional>
#include <optional>

#include <vips/vips.h>

namespace merlin::render::import {

struct ValueRange {
  double low = 0, high = 1;  // values displayed as black and white; low < high
};

// Returns whether the image's numbers are measured values and not colours. Colours are unsigned
// integers of 8 and 16 bits and high-dynamic-range colours; all other types are measured values.
bool isMeasured(const VipsImage* image) noexcept;

// A 16-bit grey image whose values are all below this limit counts as measured: thermal and depth
// cameras store 12 or 14 bits in 16, and the image would be nearly black.
inline constexpr double kMostOfDarkGrey = 16384;
bool isGrey16(const VipsImage* image) noexcept;

// Returns the range of the values without the lowest and the highest thousandth, from up to 10^6
// evenly spread pixels. NaN and infinite values are ignored. Returns nothing if there are no other
// values, or if the image cannot be read (libvips then has the reason). Reads the image once from
// top to bottom. `on_share` receives the share that has been read, 0..1.
std::optional<ValueRange> rangeOf(VipsImage* image, const std::function<void(double)>& on_share);

// Converts an image to one or three bands of 8 bits: the range becomes 0 to 255, values outside are
// clamped, and NaN becomes 0. Bands after the third are left out; of two bands the second is left
// out. Returns 0 on success and another number on failure, like functions of libvips.
int stretch(VipsImage* image, const ValueRange& range, VipsImage** made);

}  // namespace merlin::render::import
