#include "render/import/vips_pyramid.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <vips/vips.h>

#include "daemon/base/files.h"
#include "render/image/pyramid_file.h"
#include "render/import/value_range.h"
#include "render/import/vips_image.h"

namespace merlin::render::import {
namespace {

using namespace std::string_view_literals;

// Returns libvips' messages on one line and clears them; empty if there are none.
std::string reported() {
  std::string text = vips_error_buffer();
  vips_error_clear();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::ranges::replace(text, '\n', ';');
  // Message for a truncated file that is mapped.
  if (text.find("memory area too small") != std::string::npos)
    text = "it is cut short: it has fewer bytes than its header says";
  return text;
}

// Returns whether a file that begins with these bytes is a video: MP4 and QuickTime (but not HEIF
// and AVIF, which have the same boxes), Matroska and WebM, AVI, and MPEG streams.
bool isVideo(std::string_view begin) {
  if (begin.size() < 12) return false;
  const std::string_view brand = begin.substr(8, 4);
  if (begin.substr(4, 4) == "ftyp")
    return !brand.starts_with("hei") && !brand.starts_with("hev") && !brand.starts_with("avi") &&
           brand != "mif1" && brand != "msf1";
  return begin.starts_with("\x1A\x45\xDF\xA3") || begin.starts_with("\0\0\1\xBA"sv) ||
         begin.starts_with("\0\0\1\xB3"sv) || (begin.starts_with("RIFF") && brand == "AVI ");
}

Error broken(const std::string& in) {
  std::string why = reported();
  const auto begin = FileCopy::read(in, 64);
  if (begin && isVideo(begin->text()))
    return {Errc::kUnsupported,
            in + ": is a video; MERLIN shows models, pictures, panoramas and slides"};
  // The last reader that libvips tries is blocked here, so no other one knows the format.
  const bool unknown = why.find("operation is blocked") != std::string::npos ||
                       why.find("is not a known file format") != std::string::npos;
  if (why.empty() || unknown)
    why = "it is damaged or cut short, or of no format that libvips reads";
  return {Errc::kMalformed, fmt::format("{}: cannot be read as a picture: {}", in, why)};
}

// Opens a picture and turns it upright. Its rows can then be read once, from top to bottom; a
// picture that must be turned is loaded as a whole.
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

std::string textOf(const ValueRange& range) {
  return fmt::format("values from {:.6g} (black) to {:.6g} (white)", range.low, range.high);
}

constexpr double kFinding = 0.5;  // share of the work that finding the range takes

// Returns whether the picture's range must be found before the picture can be converted, for which
// it is read twice.
bool isReadTwice(const VipsImage* image, const PyramidOptions& options) {
  return !options.range && (isMeasured(image) || isGrey16(image));
}

// Returns the range that maps the picture's values to shades; nothing if the values are colours. If
// isReadTwice(), this reads the picture, which must then be opened again.
std::optional<ValueRange> rangeFor(VipsImage* image, const PyramidOptions& options,
                                   const PictureReports& reports) {
  if (options.range) return ValueRange{(*options.range)[0], (*options.range)[1]};
  if (!isReadTwice(image, options)) return std::nullopt;
  const auto found = rangeOf(image, [&](double share) { reports.progress(kFinding * share, 0); });
  // The error will be reported when the picture is read again.
  if (!found && vips_error_buffer()[0] != '\0') return std::nullopt;
  vips_error_clear();
  const bool dark = !isMeasured(image) && (!found || found->high >= kMostOfDarkGrey);
  if (dark) return std::nullopt;  // 16-bit grey is kept as it is
  const ValueRange range = found.value_or(ValueRange{});
  reports.note(found ? fmt::format("{} are shown: all but a thousandth of them at either end; "
                                   "--range LOW HIGH sets others",
                                   textOf(range))
                     : "it holds no numbers, and is black");
  return range;
}

struct Opened {
  Image image;
  double done = 0;  // share of the work that was done to find the range
};

// Opens the picture and reports its size; values that are not colours are mapped to shades.
Result<Opened> openShaded(const std::string& in, const PyramidOptions& options,
                          const PictureReports& reports) {
  auto image = open(in);
  if (!image) return image.error();
  const ImportedPicture size{vips_image_get_width(image->get()),
                             vips_image_get_height(image->get())};
  if (const auto may = reports.size(size); !may) return may.error();
  const bool twice = isReadTwice(image->get(), options);
  const auto range = rangeFor(image->get(), options, reports);
  if (twice) image = open(in);  // from the top again
  if (!image) return image.error();
  const auto shades = [&](VipsImage* from, VipsImage** to) { return stretch(from, *range, to); };
  if (range && !applyStep(*image, shades)) return broken(in);
  return Opened{*std::move(image), twice ? kFinding : 0};
}

bool toSrgb(Image& image) {
  const bool profile = vips_image_get_typeof(image.get(), VIPS_META_ICC_NAME) != 0;
  const bool by_profile =
      profile && applyStep(image, [](VipsImage* from, VipsImage** to) {
        return vips_icc_transform(from, to, "srgb", "embedded", TRUE, "depth", 8, nullptr);
      });
  if (!by_profile) vips_error_clear();  // ignores a profile that does not fit the picture
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

// Removes the file's metadata, then sets the mark of a picture or panorama.
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

// Returns 0 if the picture is suitable for a pyramid; if it is too thin, returns the number of
// pixels that its shorter side needs. Levels are halved until a side is one pixel, so the coarsest
// level of a long and thin picture could still be too long to be read.
int neededSide(const ImportedPicture& size) {
  const std::int64_t longest = std::max(size.width, size.height);
  int needed = 1;
  while (longest / needed > image::kMostCoarsest * image::kTileSide) needed *= 2;
  return std::min(size.width, size.height) < needed ? needed : 0;
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
  // Blocks readers that start other programs, or that fetch what a file names.
  for (const char* loader : {"VipsForeignLoadMagick", "VipsForeignLoadMagick7"})
    vips_operation_block_set(loader, TRUE);
  return Ok{};
}

Result<ImportedPicture> importPicture(const std::string& in, const std::string& out,
                                      const PyramidOptions& options,
                                      const PictureReports& reports) {
  auto opened = openShaded(in, options, reports);
  if (!opened) return opened.error();
  Image image = std::move(opened->image);
  const OnProgress on_progress = [&, done = opened->done](double share, std::int64_t pixels) {
    reports.progress(done + (1 - done) * share, pixels);
  };
  const ImportedPicture size{vips_image_get_width(image.get()), vips_image_get_height(image.get())};
  if (const int needed = neededSide(size); needed > 0)
    return Error{
        Errc::kUnsupported,
        fmt::format("{}: {} x {} pixels are too thin for a pyramid, whose levels are halved "
                    "until one fits a screen: the shorter side needs {} pixels; add a "
                    "border, or cut the picture into shorter ones",
                    in, size.width, size.height, needed)};
  if (!toSrgb(image) || !mark(image, options.panorama)) return broken(in);
  vips_image_set_progress(image.get(), TRUE);
  g_signal_connect(image.get(), "eval", G_CALLBACK(&evaluated),
                   const_cast<OnProgress*>(&on_progress));
  if (save(image.get(), out, options) == 0) return size;
  const std::string why = reported();
  const bool written = why.find("write") == std::string::npos &&
                       why.find("No space") == std::string::npos &&
                       why.find("too large") == std::string::npos;
  if (why.empty()) return broken(in);
  return Error{written ? Errc::kMalformed : Errc::kIo, fmt::format("{}: {}", in, why)};
}

}  // namespace merlin::render::import
