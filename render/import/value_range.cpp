#include "render/import/value_range.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "render/import/vips_image.h"

namespace merlin::render::import {
namespace {

constexpr int kRows = 64;  // number of rows read at a time
constexpr std::int64_t kMostSampled = 1'000'000;

using Region = std::unique_ptr<VipsRegion, Unref>;

int bandsShown(const VipsImage* image) { return vips_image_get_bands(image) >= 3 ? 3 : 1; }

// Returns a pointer to the first band of a pixel; `row` is counted from the top of the region.
const float* pixelAt(const VipsRegion* region, std::int64_t column, std::int64_t row) {
  const std::int64_t size = vips_image_get_bands(region->im) * std::int64_t{sizeof(float)};
  return reinterpret_cast<const float*>(region->data + row * region->bpl + column * size);
}

// Appends the finite values of every `step`th pixel of the rows, counted through the whole picture.
void sample(VipsRegion* region, const VipsRect& rows, std::int64_t step,
            std::vector<float>& values) {
  const VipsImage* const image = region->im;
  const auto shown = static_cast<std::size_t>(bandsShown(image));
  const std::int64_t width = rows.width, first = rows.top * width;
  const std::int64_t end = first + width * rows.height;
  for (std::int64_t pixel = (first + step - 1) / step * step; pixel < end; pixel += step) {
    const float* const at = pixelAt(region, pixel % width, pixel / width - rows.top);
    for (std::size_t band = 0; band < shown; ++band)
      if (std::isfinite(at[band])) values.push_back(at[band]);
  }
}

// Returns the range of the values without the lowest and the highest thousandth.
ValueRange middleOf(std::vector<float>& values) {
  const auto cut = static_cast<std::ptrdiff_t>(values.size() / 1000);
  const auto low = values.begin() + cut, high = values.end() - 1 - cut;
  std::nth_element(values.begin(), low, values.end());
  const double least = *low;
  std::nth_element(values.begin(), high, values.end());
  const double most = *high;
  return {least, most > least ? most : least + 1};
}

}  // namespace

bool isMeasured(const VipsImage* image) noexcept {
  if (vips_image_get_coding(image) != VIPS_CODING_NONE) return false;
  const VipsBandFormat format = vips_image_get_format(image);
  if (format == VIPS_FORMAT_UCHAR || format == VIPS_FORMAT_USHORT) return false;
  switch (vips_image_get_interpretation(image)) {
    case VIPS_INTERPRETATION_scRGB:
    case VIPS_INTERPRETATION_LAB:
    case VIPS_INTERPRETATION_LABS:
    case VIPS_INTERPRETATION_LCH:
    case VIPS_INTERPRETATION_CMC:
    case VIPS_INTERPRETATION_XYZ:
    case VIPS_INTERPRETATION_YXY:
    case VIPS_INTERPRETATION_HSV:
    case VIPS_INTERPRETATION_CMYK: return false;
    default: return true;
  }
}

bool isGrey16(const VipsImage* image) noexcept {
  return vips_image_get_coding(image) == VIPS_CODING_NONE &&
         vips_image_get_format(image) == VIPS_FORMAT_USHORT && vips_image_get_bands(image) == 1;
}

std::optional<ValueRange> rangeOf(VipsImage* image, const std::function<void(double)>& on_share) {
  VipsImage* cast = nullptr;
  if (vips_cast(image, &cast, VIPS_FORMAT_FLOAT, nullptr) != 0) return std::nullopt;
  const Image floats(cast);
  const Region region(vips_region_new(floats.get()));
  const int width = vips_image_get_width(image), height = vips_image_get_height(image);
  const std::int64_t pixels = std::int64_t{width} * height;
  std::vector<float> values;
  for (int y = 0; y < height; y += kRows) {
    const VipsRect rows{0, y, width, std::min(kRows, height - y)};
    if (vips_region_prepare(region.get(), &rows) != 0) return std::nullopt;
    sample(region.get(), rows, std::max<std::int64_t>(pixels / kMostSampled, 1), values);
    on_share(static_cast<double>(y) / height);
  }
  if (values.empty()) return std::nullopt;
  return middleOf(values);
}

int stretch(VipsImage* image, const ValueRange& range, VipsImage** made) {
  const double scale = 255 / (range.high - range.low);
  const int bands = bandsShown(image);
  g_object_ref(image);
  Image shades(image);
  const bool cast = applyStep(shades,
                              [&](VipsImage* from, VipsImage** to) {
                                return vips_extract_band(from, to, 0, "n", bands, nullptr);
                              }) &&
                    applyStep(shades, [](VipsImage* from, VipsImage** to) {
                      return vips_cast(from, to, VIPS_FORMAT_FLOAT, nullptr);
                    });
  if (!cast) return -1;
  g_object_ref(shades.get());
  Image numbers(shades.get());  // 255 where a value is a number (equal to itself), else 0
  const bool shaded =
      applyStep(numbers,
                [](VipsImage* from, VipsImage** to) {
                  return vips_relational(from, from, to, VIPS_OPERATION_RELATIONAL_EQUAL, nullptr);
                }) &&
      applyStep(shades,
                [&](VipsImage* from, VipsImage** to) {
                  return vips_linear1(from, to, scale, 0.5 - range.low * scale, "uchar", TRUE,
                                      nullptr);
                }) &&
      applyStep(shades,
                [&](VipsImage* from, VipsImage** to) {
                  return vips_boolean(from, numbers.get(), to, VIPS_OPERATION_BOOLEAN_AND, nullptr);
                }) &&
      applyStep(shades, [&](VipsImage* from, VipsImage** to) {
        return vips_copy(from, to, "interpretation",
                         bands == 3 ? VIPS_INTERPRETATION_sRGB : VIPS_INTERPRETATION_B_W, nullptr);
      });
  if (!shaded) return -1;
  vips_image_remove(shades.get(), VIPS_META_ICC_NAME);
  *made = shades.release();
  return 0;
}

}  // namespace merlin::render::import
