#include "render/import/value_range.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

namespace merlin::render::import {
namespace {

constexpr int kRows = 64;  // read at a time
constexpr std::int64_t kMostSampled = 1'000'000;

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
using Image = std::unique_ptr<VipsImage, Unref>;
using Region = std::unique_ptr<VipsRegion, Unref>;

int bandsShown(const VipsImage* image) { return vips_image_get_bands(image) >= 3 ? 3 : 1; }

// The first band of a pixel; `row` is counted from the top of what the region holds.
const float* pixelAt(const VipsRegion* region, std::int64_t column, std::int64_t row) {
  const std::int64_t size = vips_image_get_bands(region->im) * std::int64_t{sizeof(float)};
  return reinterpret_cast<const float*>(region->data + row * region->bpl + column * size);
}

// Every `step`th pixel of the rows, counted through the whole picture.
void sample(VipsRegion* region, const VipsRect& rows, std::int64_t step,
            std::vector<float>& values) {
  const VipsImage* const image = region->im;
  const auto bands = static_cast<std::size_t>(vips_image_get_bands(image));
  const auto shown = static_cast<std::size_t>(bandsShown(image));
  const std::int64_t width = rows.width, first = rows.top * width;
  const std::int64_t end = first + width * rows.height;
  for (std::int64_t pixel = (first + step - 1) / step * step; pixel < end; pixel += step) {
    const float* const at = pixelAt(region, pixel % width, pixel / width - rows.top);
    for (std::size_t band = 0; band < std::min(bands, shown); ++band)
      if (std::isfinite(at[band])) values.push_back(at[band]);
  }
}

// All but a thousandth on either side.
ValueRange middleOf(std::vector<float>& values) {
  const auto cut = static_cast<std::ptrdiff_t>(values.size() / 1000);
  const auto low = values.begin() + cut, high = values.end() - 1 - cut;
  std::nth_element(values.begin(), low, values.end());
  const double least = *low;
  std::nth_element(values.begin(), high, values.end());
  const double most = *high;
  return {least, most > least ? most : least + 1};
}

// One step of libvips after another; keeps what the earlier ones made.
class Steps {
 public:
  explicit Steps(VipsImage* from) : now_(from) {}
  template <typename Step>
  bool then(const Step& step) {
    VipsImage* made = nullptr;
    if (step(now_, &made) != 0) return false;
    kept_.emplace_back(made);
    now_ = made;
    return true;
  }
  VipsImage* now() const { return now_; }

 private:
  VipsImage* now_;
  std::vector<Image> kept_;
};

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
  Steps steps(image);
  if (!steps.then([](VipsImage* from, VipsImage** to) {
        return vips_cast(from, to, VIPS_FORMAT_FLOAT, nullptr);
      }))
    return std::nullopt;
  const Region region(vips_region_new(steps.now()));
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
  Steps steps(image);
  const bool cast = steps.then([&](VipsImage* from, VipsImage** to) {
    return vips_extract_band(from, to, 0, "n", bandsShown(image), nullptr);
  }) && steps.then([](VipsImage* from, VipsImage** to) {
    return vips_cast(from, to, VIPS_FORMAT_FLOAT, nullptr);
  });
  if (!cast) return -1;
  Steps numbers(steps.now()), shades(steps.now());
  const bool both = numbers.then([](VipsImage* from,
                                    VipsImage** to) {  // what is no number is not itself
    return vips_relational(from, from, to, VIPS_OPERATION_RELATIONAL_EQUAL, nullptr);
  }) && shades.then([&](VipsImage* from, VipsImage** to) {
    return vips_linear1(from, to, scale, 0.5 - range.low * scale, "uchar", TRUE, nullptr);
  });
  if (!both) return -1;
  const double black = 0;
  Image none;
  {
    VipsImage* constant = nullptr;
    if (vips_linear(shades.now(), &constant, &black, &black, 1, "uchar", TRUE, nullptr) != 0)
      return -1;
    none.reset(constant);
  }
  const bool joined = shades.then([&](VipsImage* from, VipsImage** to) {
    return vips_ifthenelse(numbers.now(), from, none.get(), to, nullptr);
  }) && shades.then([&](VipsImage* from, VipsImage** to) {
    return vips_copy(from, to, "interpretation",
                     bandsShown(image) == 3 ? VIPS_INTERPRETATION_sRGB : VIPS_INTERPRETATION_B_W,
                     nullptr);
  });
  if (!joined) return -1;
  *made = shades.now();
  g_object_ref(*made);
  vips_image_remove(*made, VIPS_META_ICC_NAME);
  return 0;
}

}  // namespace merlin::render::import
