#include "render/import/fits_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <fitsio.h>
#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "daemon/base/words.h"
#include "render/range/range_image.h"

namespace merlin::render::import {
namespace {

constexpr int kMostAxes = 9, kMostImages = 1000;

// Returns CFITSIO's message for a status, on one line.
std::string wordsOf(int status) {
  std::array<char, FLEN_STATUS> text{};
  fits_get_errstatus(status, text.data());
  std::string words = oneLine(text.data());
  std::array<char, FLEN_ERRMSG> more{};
  if (fits_read_errmsg(more.data()) != 0) words += fmt::format(" ({})", oneLine(more.data()));
  fits_clear_errmsg();
  return words;
}

struct CloseFits {
  void operator()(fitsfile* file) const {
    int status = 0;
    fits_close_file(file, &status);
  }
};
using File = std::unique_ptr<fitsfile, CloseFits>;

// Reads the cards (header records) of an image. The first fault is kept in fault().
class Cards {
 public:
  explicit Cards(fitsfile* file) : file_(file) {}

  std::optional<double> number(const std::string& name) {
    double value = 0;
    const bool there = read(name, TDOUBLE, &value);
    if (there && !(std::abs(value) <= 1e30)) setFault(name, "is not a number of up to 1e30");
    return there && fault_.empty() ? std::optional(value) : std::nullopt;
  }
  // Reads a text of any length, including the cards that continue it; empty if the card is missing.
  std::string text(const std::string& name) {
    char* value = nullptr;
    int status = 0;
    fits_read_key_longstr(file_, name.c_str(), &value, nullptr, &status);
    const std::string found = value ? std::string(trimmed(value)) : std::string();
    int freed = 0;
    if (value) fits_free_memory(value, &freed);
    return noted(name, status) ? found : std::string();
  }
  void setFault(const std::string& name, const std::string& what) {
    if (fault_.empty()) fault_ = fmt::format("card {}: {}", name, what);
  }
  const std::string& fault() const noexcept { return fault_; }

 private:
  bool read(const std::string& name, int type, void* value) {
    int status = 0;
    fits_read_key(file_, type, name.c_str(), value, nullptr, &status);
    return noted(name, status);
  }
  // Records a fault, unless the card is missing. Returns whether the card was read.
  bool noted(const std::string& name, int status) {
    if (status != 0 && status != KEY_NO_EXIST && status != VALUE_UNDEFINED)
      setFault(name, wordsOf(status));
    fits_clear_errmsg();
    return status == 0;
  }

  fitsfile* file_;
  std::string fault_;
};

void readAngles(Cards& cards, range::ImageHeader& header, std::size_t rows) {
  const auto across = cards.number("ANGLEH"), down = cards.number("ANGLEV");
  if (across) header.angles_deg = {*across, down.value_or(0)};
  if (!cards.number("ALT1")) return;
  constexpr double kRadians = std::numbers::pi / 180;
  for (std::size_t row = 1; row <= rows && cards.fault().empty(); ++row) {
    const std::string altitude = fmt::format("ALT{}", row);
    const auto value = cards.number(altitude);
    if (!value) cards.setFault(altitude, fmt::format("is missing; there are {} rows", rows));
    const double azimuth = cards.number(fmt::format("AZI{}", row)).value_or(0);
    header.beams.push_back({value.value_or(0) * kRadians, azimuth * kRadians});
  }
}

void readCamera(Cards& cards, range::ImageHeader& header) {
  if (!cards.number("CAM11")) return;
  header.camera = range::kIdentity;
  for (std::size_t i = 0; i < 12; ++i) {
    const std::string name = fmt::format("CAM{}{}", i / 4 + 1, i % 4 + 1);
    const auto value = cards.number(name);
    if (!value) cards.setFault(name, "is missing; the camera is CAM11 to CAM34");
    (*header.camera)[i] = value.value_or(0);
  }
}

// Reads the cards FEAT1, FEAT2, ..., which name files of registered images, like the key `feature`.
void readFeatures(Cards& cards, range::ImageHeader& header) {
  for (std::size_t i = 1;; ++i) {
    const std::string name = fmt::format("FEAT{}", i);
    const std::string value = cards.text(name);
    if (value.empty()) return;
    if (const auto added = range::applyLine("feature: " + oneLine(value), header); !added)
      return cards.setFault(name, added.error().what);
  }
}

void readScale(Cards& cards, range::GridHead& head) {
  constexpr std::pair<const char*, double> kUnits[] = {
      {"m", 1},     {"metre", 1}, {"meter", 1},   {"metres", 1},    {"meters", 1},   {"mm", 0.001},
      {"cm", 0.01}, {"km", 1000}, {"ft", 0.3048}, {"foot", 0.3048}, {"feet", 0.3048}};
  const std::string unit = cards.text("BUNIT");
  for (const auto& [name, metres] : kUnits) {
    if (lowerCase(unit) == name) head.header.scale = metres;
  }
  if (!unit.empty() && !head.header.scale)
    head.notes.push_back(
        fmt::format("BUNIT {} is not a known unit of length", oneLine(excerpt(unit))));
  if (const auto scale = cards.number("SCALE")) head.header.scale = scale;
}

void readGeometry(Cards& cards, range::GridHead& head) {
  const std::string name = cards.text("GEOMETRY");
  head.header.scanner = range::scannerOf(lowerCase(name));
  if (!name.empty() && !head.header.scanner)
    cards.setFault("GEOMETRY", fmt::format("found \"{}\", allowed: orthogonal, spinning, pinhole, "
                                           "elevation",
                                           oneLine(excerpt(name))));
  readAngles(cards, head.header, head.height);
  if (const auto x = cards.number("CELLX")) {
    const auto y = cards.number("CELLY");
    head.header.cell = {*x, y.value_or(*x)};
  }
  head.header.no_return = cards.number("NORETURN");
  const std::string projection = cards.text("PROJECTN");
  if (!projection.empty()) head.header.projection = oneLine(projection);
  readCamera(cards, head.header);
  readFeatures(cards, head.header);
  readScale(cards, head);
}

class FitsGrid final : public GridSource {
 public:
  explicit FitsGrid(File file) : file_(std::move(file)) {}

  // Finds the image `wanted` and reads its cards. Errors: as openFits().
  Result<Ok> prepare(const std::string& wanted) {
    if (const auto found = findImage(wanted); !found) return found;
    head_.format = "FITS";
    Cards cards(file_.get());
    const std::string order = lowerCase(cards.text("ROWORDER"));
    bottom_first_ = order == "bottom-up";
    if (!order.empty() && !bottom_first_ && order != "top-down")
      cards.setFault("ROWORDER", fmt::format("found \"{}\", allowed: TOP-DOWN, BOTTOM-UP",
                                             oneLine(excerpt(order))));
    readGeometry(cards, head_);
    if (cards.fault().empty()) return Ok{};
    return Error{Errc::kMalformed, cards.fault()};
  }

  const range::GridHead& head() const override { return head_; }

  std::string readRow(std::size_t row, std::span<float> values) override {
    std::array<long, kMostAxes> first{};
    first.fill(1);
    first[1] = static_cast<long>(bottom_first_ ? head_.height - row : row + 1);
    float none = std::numeric_limits<float>::quiet_NaN();
    int status = 0, any = 0;  // CFITSIO 4.2 would write to `any` even if it were null
    fits_read_pix(file_.get(), TFLOAT, first.data(), static_cast<LONGLONG>(values.size()), &none,
                  values.data(), &any, &status);
    // A number that is too large for a float also counts as no return.
    if (status == 0 || status == NUM_OVERFLOW) return {};
    return wordsOf(status);
  }

 private:
  // Selects the image `wanted`; if that is empty, the first image.
  Result<Ok> findImage(const std::string& wanted) {
    if (const auto listed = listImages(); !listed) return listed;
    if (images_.empty()) return Error{Errc::kUnsupported, "has no image of two axes"};
    const auto chosen = std::ranges::find_if(
        images_, [&](const Image& i) { return wanted.empty() || isCalled(i, wanted); });
    if (chosen == images_.end())
      return Error{Errc::kInvalidArgument,
                   fmt::format("has no image {} of two axes (--hdu); there are {}",
                               oneLine(excerpt(wanted)), listOf(images_))};
    head_.width = chosen->width;
    head_.height = chosen->height;
    if (head_.width > range::kMostPixels / head_.height)
      return Error{Errc::kUnsupported, fmt::format("image {}; allowed are {} pixels",
                                                   nameOf(*chosen), range::kMostPixels)};
    int type = 0, status = 0;
    if (fits_movabs_hdu(file_.get(), chosen->number + 1, &type, &status) != 0)
      return Error{Errc::kMalformed, fmt::format("image {}: {}", nameOf(*chosen), wordsOf(status))};
    if (wanted.empty() && images_.size() > 1) {
      const std::vector<Image> others(chosen + 1, images_.end());
      head_.notes.push_back(fmt::format("left out: {}; image {} is read (--hdu reads another one)",
                                        listOf(others), nameOf(*chosen)));
    }
    return Ok{};
  }

  // An image of two axes.
  struct Image {
    int number = 0;      // number of its header-data unit; 0: the primary one
    std::string name{};  // value of the card EXTNAME, one line
    std::size_t width = 0, height = 0;
  };

  // Lists the images of the file. If the file is damaged after an image, lists the images before
  // the damage.
  Result<Ok> listImages() {
    int units = 0, status = 0;
    if (fits_get_num_hdus(file_.get(), &units, &status) != 0)
      return Error{Errc::kMalformed, wordsOf(status)};
    for (int i = 0; i < std::min(units, kMostImages); ++i) {
      int type = 0;
      status = 0;
      if (fits_movabs_hdu(file_.get(), i + 1, &type, &status) != 0) {
        const std::string words = wordsOf(status);
        if (images_.empty()) return Error{Errc::kMalformed, fmt::format("image {}: {}", i, words)};
        return Ok{};
      }
      const bool image = type == IMAGE_HDU || fits_is_compressed_image(file_.get(), &status) != 0;
      if (!image || !takeSize()) continue;
      images_.push_back(
          {i, oneLine(Cards(file_.get()).text("EXTNAME")), head_.width, head_.height});
    }
    return Ok{};
  }

  // Returns whether `wanted` is the image's number or, ignoring case, its name.
  static bool isCalled(const Image& image, const std::string& wanted) {
    return std::to_string(image.number) == wanted ||
           (!image.name.empty() && lowerCase(image.name) == lowerCase(wanted));
  }

  static std::string nameOf(const Image& image) {
    return fmt::format("{}{} ({} x {} pixels)", image.number,
                       image.name.empty() ? "" : fmt::format(" \"{}\"", excerpt(image.name)),
                       image.width, image.height);
  }

  static std::string listOf(const std::vector<Image>& images) {
    constexpr std::size_t kNamed = 8;
    std::string list;
    for (std::size_t i = 0; i < std::min(images.size(), kNamed); ++i)
      list += (i == 0 ? "" : ", ") + nameOf(images[i]);
    return images.size() > kNamed ? fmt::format("{} and {} more", list, images.size() - kNamed)
                                  : list;
  }

  // Stores the image's size in head_. Returns whether the image has two axes; further axes of
  // length 1 are allowed.
  bool takeSize() {
    int axes = 0, status = 0;
    std::array<LONGLONG, kMostAxes> sizes{};
    fits_get_img_dim(file_.get(), &axes, &status);
    if (status != 0 || axes < 2 || axes > kMostAxes) return false;
    if (fits_get_img_sizell(file_.get(), axes, sizes.data(), &status) != 0) return false;
    for (int k = 0; k < axes; ++k) {
      const LONGLONG n = sizes[static_cast<std::size_t>(k)];
      if (n < 1 || (k >= 2 && n > 1)) return false;
    }
    head_.width = static_cast<std::size_t>(sizes[0]);
    head_.height = static_cast<std::size_t>(sizes[1]);
    return true;
  }

  File file_;
  range::GridHead head_;
  std::vector<Image> images_;
  bool bottom_first_ = false;
};

}  // namespace

bool isFits(std::string_view bytes) noexcept { return bytes.starts_with("SIMPLE  ="); }

Result<std::unique_ptr<GridSource>> openFits(const std::string& path, const std::string& wanted) {
  fitsfile* opened = nullptr;
  int status = 0;
  // This call uses the file name as it is; fits_open_file() would also interpret an extended
  // syntax.
  if (fits_open_diskfile(&opened, path.c_str(), READONLY, &status) != 0)
    return Error{Errc::kMalformed, wordsOf(status)};
  auto grid = std::make_unique<FitsGrid>(File(opened));
  if (const auto prepared = grid->prepare(wanted); !prepared) return prepared.error();
  return std::unique_ptr<GridSource>(std::move(grid));
}

}  // namespace merlin::render::import
