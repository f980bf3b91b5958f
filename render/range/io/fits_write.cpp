#include "render/range/io/fits_write.h"

#include <bit>
#include <cassert>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/bytes.h"
#include "render/range/io/words.h"

namespace merlin::render::range {
namespace {

constexpr std::size_t kCard = 80, kBlock = 2880;

// Builds the header of one image: cards of 80 characters, filled up to whole blocks of 2880 bytes.
class FitsHeader {
 public:
  void add(std::string_view name, std::string_view value) {
    card(fmt::format("{:<8}= {:>20}", name, value));
  }
  void addNumber(std::string_view name, double value) { add(name, fmt::format("{}", value)); }

  // Adds a text. A text that is too long for one card continues on the next cards.
  void addText(std::string_view name, std::string_view text) {
    constexpr std::size_t kPart = 67;  // characters between quotes, with room for '&'
    const std::string quoted = withQuotesDoubled(text);
    std::string before = fmt::format("{:<8}= ", name);
    for (std::size_t begin = 0;;) {
      std::size_t length = quoted.size() - begin;
      const bool last = length <= kPart;
      if (!last) length = wholeQuotes(quoted, begin, kPart);
      card(fmt::format("{}'{:<8}'", before, quoted.substr(begin, length).append(last ? "" : "&")));
      if (last) return;
      begin += length;
      before = "CONTINUE  ";
    }
  }

  std::string finish() {
    card("END");
    cards_.append((kBlock - cards_.size() % kBlock) % kBlock, ' ');
    return std::move(cards_);
  }

 private:
  void card(std::string text) {
    assert(text.size() <= kCard);
    text.resize(kCard, ' ');
    cards_ += text;
  }
  static std::string withQuotesDoubled(std::string_view text) {
    std::string quoted;
    for (const char c : text) quoted.append(c == '\'' ? 2 : 1, c);
    return quoted;
  }
  // Returns `length`, or length - 1 if a cut at `length` would split the two characters of a
  // doubled quote.
  static std::size_t wholeQuotes(const std::string& quoted, std::size_t begin, std::size_t length) {
    std::size_t quotes = 0;
    while (quotes < length && quoted[begin + length - 1 - quotes] == '\'') ++quotes;
    return quotes % 2 == 0 ? length : length - 1;
  }

  std::string cards_;
};

void addGeometry(FitsHeader& cards, const ImageHeader& header) {
  cards.addText("GEOMETRY", nameOf(*header.scanner));
  if (header.angles_deg) {
    cards.addNumber("ANGLEH", (*header.angles_deg)[0]);
    cards.addNumber("ANGLEV", (*header.angles_deg)[1]);
  }
  for (std::size_t row = 0; row < header.beams.size(); ++row) {
    cards.addNumber(fmt::format("ALT{}", row + 1), header.beams[row].altitude_rad / kDegree);
    cards.addNumber(fmt::format("AZI{}", row + 1), header.beams[row].azimuth_rad / kDegree);
  }
  if (!header.camera) return;
  for (std::size_t i = 0; i < 12; ++i)
    cards.addNumber(fmt::format("CAM{}{}", i / 4 + 1, i % 4 + 1), (*header.camera)[i]);
}

std::string headerText(const RangeImage& image, const std::vector<FeatureFile>& features) {
  FitsHeader cards;
  cards.add("SIMPLE", "T");
  cards.add("BITPIX", "-32");
  cards.add("NAXIS", "2");
  cards.add("NAXIS1", fmt::format("{}", image.width));
  cards.add("NAXIS2", fmt::format("{}", image.height));
  cards.addText("ROWORDER", "TOP-DOWN");
  cards.addText("CREATOR", "MERLIN");
  if (!image.unit.empty()) cards.addText("BUNIT", image.unit);
  addGeometry(cards, headerOf(image));
  for (std::size_t i = 0; i < features.size(); ++i)
    cards.addText(fmt::format("FEAT{}", i + 1), features[i].name + "=" + features[i].file);
  return cards.finish();
}

void appendBeFloat(std::string& out, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  appendBe16(out, static_cast<std::uint16_t>(bits >> 16));
  appendBe16(out, static_cast<std::uint16_t>(bits & 0xFFFF));
}

}  // namespace

bool writeFits(const RangeImage& image, const WriteBytes& write,
               const std::vector<FeatureFile>& features) {
  assert(image.geometry.scanner != Scanner::kRays && image.geometry.scanner != Scanner::kElevation);
  std::string text = headerText(image, features);
  if (!write(std::as_bytes(std::span(text)))) return false;
  for (std::size_t row = 0; row < image.height; ++row) {
    text.clear();
    for (std::size_t p = row * image.width; p < (row + 1) * image.width; ++p) {
      appendBeFloat(text, isReturn(image.range[p]) ? image.range[p]
                                                   : std::numeric_limits<float>::quiet_NaN());
    }
    if (!write(std::as_bytes(std::span(text)))) return false;
  }
  const std::size_t bytes = image.width * image.height * sizeof(float);
  text.assign((kBlock - bytes % kBlock) % kBlock, '\0');
  return text.empty() || write(std::as_bytes(std::span(text)));
}

}  // namespace merlin::render::range
