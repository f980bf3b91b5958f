#include "render/import/vips_pyramid.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <vips/vips.h>

#include "render/image/pyramid_file.h"

namespace merlin::render::import {
namespace {

struct Unref {
  void operator()(VipsImage* image) const { g_object_unref(image); }
};
using Image = std::unique_ptr<VipsImage, Unref>;

// What libvips reported, on one line.
std::string reported() {
  std::string text = vips_error_buffer();
  vips_error_clear();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::ranges::replace(text, '\n', ';');
  return text.empty() ? "libvips gives no reason" : text;
}

Error broken(const std::string& in) {
  return {Errc::kMalformed, fmt::format("{}: cannot be read as a picture: {}", in, reported())};
}

// A step of the way: replaces the image by what `step` makes of it. `step` returns what functions
// of libvips return: 0 for success.
template <typename Step>
bool applyStep(Image& image, const Step& step) {
  VipsImage* made = nullptr;
  if (step(image.get(), &made) != 0) return false;
  image.reset(made);
  return true;
}

// Rows are read once, from top to bottom; a picture that must be turned is needed as a whole.
Result<Image> open(const std::string& in) {
  for (const VipsAccess access : {VIPS_ACCESS_SEQUENTIAL, VIPS_ACCESS_RANDOM}) {
    Image image(vips_image_new_from_file(in.c_str(), "access", access, "fail_on",
                                         VIPS_FAIL_ON_TRUNCATED, nullptr));
    if (!image) return broken(in);
    if (access == VIPS_ACCESS_SEQUENTIAL && vips_image_get_orientation(image.get()) > 1) continue;
    const auto upright = [](VipsImage* from, VipsImage** to) {
      return vips_autorot(from, to, nullptr);
    };
    if (access == VIPS_ACCESS_RANDOM && !applyStep(image, upright)) return broken(in);
    return image;
  }
  return broken(in);
}

bool toSrgb(Image& image) {
  const bool profile = vips_image_get_typeof(image.get(), VIPS_META_ICC_NAME) != 0;
  const bool by_profile =
      profile && applyStep(image, [](VipsImage* from, VipsImage** to) {
        return vips_icc_transform(from, to, "srgb", "embedded", TRUE, "depth", 8, nullptr);
      });
  if (!by_profile) vips_error_clear();  // a profile that does not fit the picture is left out
  if (vips_image_get_coding(image.get()) == VIPS_CODING_RAD &&
      !applyStep(image,
                 [](VipsImage* from, VipsImage** to) { return vips_rad2float(from, to, nullptr); }))
    return false;
  if (!applyStep(image, [](VipsImage* from, VipsImage** to) {
        return vips_colourspace(from, to, VIPS_INTERPRETATION_sRGB, nullptr);
      }))
    return false;
  if (vips_image_hasalpha(image.get()) && !applyStep(image, [](VipsImage* from, VipsImage** to) {
        return vips_flatten(from, to, nullptr);
      }))
    return false;
  if (vips_image_get_bands(image.get()) > 3 &&
      !applyStep(image, [](VipsImage* from, VipsImage** to) {
        return vips_extract_band(from, to, 0, "n", 3, nullptr);
      }))
    return false;
  return applyStep(image, [](VipsImage* from, VipsImage** to) {
    return vips_cast(from, to, VIPS_FORMAT_UCHAR, nullptr);
  });
}

// Only the mark is left of what a file says about itself.
bool mark(Image& image, bool panorama) {
  if (!applyStep(image,
                 [](VipsImage* from, VipsImage** to) { return vips_copy(from, to, nullptr); }))
    return false;
  for (const char* name : {VIPS_META_EXIF_NAME, VIPS_META_XMP_NAME, VIPS_META_IPTC_NAME,
                           VIPS_META_PHOTOSHOP_NAME, VIPS_META_ICC_NAME, VIPS_META_ORIENTATION})
    vips_image_remove(image.get(), name);
  vips_image_set_string(image.get(), VIPS_META_IMAGEDESCRIPTION,
                        panorama ? image::kPanoramaMark : image::kPictureMark);
  return true;
}

void evaluated(VipsImage* /*image*/, VipsProgress* progress, void* data) {
  const auto& on_progress = *static_cast<const OnProgress*>(data);
  on_progress(static_cast<double>(progress->npels) /
                  static_cast<double>(std::max<gint64>(progress->tpels, 1)),
              progress->npels);
}

int save(VipsImage* image, const std::string& out, const PyramidOptions& options) {
  const bool lossy = options.quality > 0;
  return vips_tiffsave(
      image, out.c_str(), "tile", TRUE, "tile_width", options.tile_px, "tile_height",
      options.tile_px, "pyramid", TRUE, "subifd", TRUE, "bigtiff", TRUE, "compression",
      lossy ? VIPS_FOREIGN_TIFF_COMPRESSION_JPEG : VIPS_FOREIGN_TIFF_COMPRESSION_DEFLATE,
      "predictor", VIPS_FOREIGN_TIFF_PREDICTOR_HORIZONTAL, "Q", lossy ? options.quality : 75,
      "region_shrink", VIPS_REGION_SHRINK_MEAN, nullptr);
}

}  // namespace

Result<Ok> prepareImport(const char* program) {
  if (VIPS_INIT(program) != 0) return Error{Errc::kUnsupported, "libvips: " + reported()};
  vips_cache_set_max(0);
  // They start other programs, or fetch what a file names.
  for (const char* loader : {"VipsForeignLoadMagick", "VipsForeignLoadMagick7"})
    vips_operation_block_set(loader, TRUE);
  return Ok{};
}

Result<ImportedPicture> importPicture(const std::string& in, const std::string& out,
                                      const PyramidOptions& options, const OnSize& on_size,
                                      const OnProgress& on_progress) {
  auto opened = open(in);
  if (!opened) return opened.error();
  Image image = *std::move(opened);
  const ImportedPicture size{vips_image_get_width(image.get()), vips_image_get_height(image.get())};
  if (const auto may = on_size(size); !may) return may.error();
  if (!toSrgb(image) || !mark(image, options.panorama)) return broken(in);
  vips_image_set_progress(image.get(), TRUE);
  g_signal_connect(image.get(), "eval", G_CALLBACK(&evaluated),
                   const_cast<OnProgress*>(&on_progress));
  if (save(image.get(), out, options) == 0) return size;
  const std::string why = reported();
  const bool written = why.find("write") == std::string::npos &&
                       why.find("No space") == std::string::npos &&
                       why.find("too large") == std::string::npos;
  return Error{written ? Errc::kMalformed : Errc::kIo, fmt::format("{}: {}", in, why)};
}

}  // namespace merlin::render::import
