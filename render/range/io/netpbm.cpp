#include "render/range/io/netpbm.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/bytes.h"
#include "daemon/base/huge_vector.h"
#include "daemon/base/printable_text.h"
#include "render/range/colours.h"
#include "render/range/io/words.h"

namespace merlin::render::range {
namespace {

// Limit of the header with its comments [bytes].
constexpr std::size_t kMostHeader = std::size_t{1} << 22;

bool isBlank(char c) { return kSpaces.find(c) != std::string_view::npos; }

// Reads the words and comments before the pixels.
class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, ImageHeader& header)
      : bytes_(bytes.substr(0, kMostHeader)), header_(header) {}

  // Reads the next number, which must be 1 to `most`. `what`: name of the number, for messages.
  Result<std::size_t> number(const char* what, std::size_t most) {
    if (const auto skipped = skipBlanks(); !skipped) return skipped.error();
    const std::size_t start = at_;
    while (at_ < bytes_.size() && !isBlank(bytes_[at_]) && bytes_[at_] != '#') ++at_;
    const std::string_view word = bytes_.substr(start, at_ - start);
    std::size_t value = 0;
    if (readNumber(word, value) && value >= 1 && value <= most) return value;
    return fault(Errc::kMalformed, word.empty()
                                       ? fmt::format("the file ends before the {}", what)
                                       : fmt::format("the {} is \"{}\"; allowed are 1 to {}", what,
                                                     oneLine(excerpt(word)), most));
  }
  // Returns the offset of the pixels, which begin after the single blank that ends the header.
  std::size_t pixels() const { return std::min(at_ + 1, bytes_.size()); }
  void skip(std::size_t n) { at_ += n; }

  Error fault(Errc code, const std::string& what) const {
    return {code, fmt::format("line {}: {}", line_, what)};
  }

 private:
  Result<Ok> skipBlanks() {
    for (; at_ < bytes_.size(); ++at_) {
      if (bytes_[at_] == '#') {
        std::string_view rest = bytes_.substr(at_ + 1);
        const std::string_view line = takeLine(rest);
        if (const auto applied = applyLine(line, header_); !applied)
          return fault(applied.error().code, applied.error().what);
        at_ = std::min(at_ + 1 + line.size(), bytes_.size() - 1);
      } else if (!isBlank(bytes_[at_])) {
        break;
      }
      line_ += bytes_[at_] == '\n';
    }
    return Ok{};
  }

  std::string_view bytes_;
  ImageHeader& header_;
  std::size_t at_ = 0, line_ = 1;
};

Error tooShort(const StoredImage& image, std::size_t needed, std::size_t there) {
  return {Errc::kMalformed, fmt::format("has {} bytes of pixels; {} x {} pixels take {}", there,
                                        image.width, image.height, needed)};
}

Result<Ok> readBinary(std::string_view bytes, StoredImage& image) {
  const std::size_t n = image.width * image.height * image.channels;
  const std::size_t size = image.largest > 255 ? 2 : 1;
  if (bytes.size() < n * size) return tooShort(image, n * size, bytes.size());
  resizeHuge(image.values, n);
  const auto* p = reinterpret_cast<const std::uint8_t*>(bytes.data());
  if (size == 1)
    std::copy_n(p, n, image.values.begin());
  else
    for (std::size_t i = 0; i < n; ++i) image.values[i] = loadBe16(p + 2 * i);
  if (bytes.size() > n * size)
    image.notes.push_back(
        fmt::format("{} bytes after the pixels are ignored", bytes.size() - n * size));
  return Ok{};
}

Result<Ok> readText(std::string_view text, StoredImage& image) {
  const std::size_t n = image.width * image.height * image.channels;
  if (text.size() / 2 + 1 < n) return tooShort(image, 2 * n - 1, text.size());
  image.values.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::string_view word = takeWord(text);
    unsigned value = 0;
    if (!readNumber(word, value) || value > image.largest)
      return Error{Errc::kMalformed,
                   word.empty()
                       ? fmt::format("ends after {} of {} numbers", i, n)
                       : fmt::format("pixel {}: \"{}\"; allowed are 0 to {}", i / image.channels,
                                     oneLine(excerpt(word)), image.largest)};
    image.values.push_back(static_cast<float>(value));
  }
  return Ok{};
}

}  // namespace

bool isNetpbm(std::string_view bytes) noexcept {
  return bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '7' &&
         (isBlank(bytes[2]) || bytes[2] == '#');
}

Result<StoredImage> parseNetpbm(std::string_view bytes) {
  if (!isNetpbm(bytes)) return Error{Errc::kMalformed, "is not a PGM or PPM file"};
  const char kind = bytes[1];
  if (kind != '2' && kind != '3' && kind != '5' && kind != '6')
    return Error{Errc::kUnsupported, fmt::format("is of kind P{}; P2, P5 (PGM), P3 and P6 (PPM) "
                                                 "are read",
                                                 kind)};
  StoredImage image;
  image.channels = kind == '3' || kind == '6' ? 3 : 1;
  HeaderReader reader(bytes, image.header);
  reader.skip(2);
  const auto width = reader.number("width", kMostPixels);
  if (!width) return width.error();
  const auto height = reader.number("height", kMostPixels);
  if (!height) return height.error();
  const auto largest = reader.number("largest value", 65535);
  if (!largest) return largest.error();
  image.width = *width;
  image.height = *height;
  image.largest = static_cast<double>(*largest);
  if (image.width * image.height > kMostPixels)
    return reader.fault(Errc::kUnsupported, fmt::format("{} x {} pixels; allowed are {}", *width,
                                                        *height, kMostPixels));
  const std::string_view pixels = bytes.substr(std::min(reader.pixels(), bytes.size()));
  const auto read = kind >= '5' ? readBinary(pixels, image) : readText(pixels, image);
  if (!read) return read.error();
  return image;
}

bool writePgm(const RangeImage& image, int bits, const WriteBytes& write,
              const std::vector<FeatureFile>& features) {
  assert(bits == 8 || bits == 16);
  const double largest = bits == 8 ? 255 : 65535;
  const Ends ends = endsOf(image.range);
  ImageHeader header = headerOf(image);
  // Without a unit, a reader would assume metres, as the header has a minimum and a maximum.
  if (header.unit.empty() && image.geometry.scanner != Scanner::kElevation) header.unit = "unknown";
  // The nearest range is stored as 1, since 0 means no return.
  const double span = std::max(double{ends.high} - ends.low, 1e-6 * std::abs(ends.high) + 1e-30);
  const double step = span / (largest - 1);
  header.minimum = ends.low - step;
  header.maximum = ends.low + step * (largest - 1);
  header.no_return = 0;
  header.features = features;
  std::string text = fmt::format("P5\n# range image, written by MERLIN\n{}{} {}\n{}\n",
                                 linesOf(header, "# "), image.width, image.height, largest);
  if (!write(std::as_bytes(std::span(text)))) return false;
  for (std::size_t row = 0; row < image.height; ++row) {
    text.clear();
    for (std::size_t p = row * image.width; p < (row + 1) * image.width; ++p) {
      const double stored = std::clamp((image.range[p] - ends.low) / step + 1, 1.0, largest);
      const auto value =
          static_cast<std::uint16_t>(isReturn(image.range[p]) ? std::lround(stored) : 0);
      if (bits == 16)
        appendBe16(text, value);
      else
        text.push_back(static_cast<char>(value));
    }
    if (!write(std::as_bytes(std::span(text)))) return false;
  }
  return true;
}

}  // namespace merlin::render::range
