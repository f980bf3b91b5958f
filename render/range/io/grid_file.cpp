#include "render/range/io/grid_file.h"

#include <cmath>

#include <fmt/format.h>

#include "daemon/base/bytes.h"
#include "daemon/base/huge_vector.h"
#include "daemon/base/printable_text.h"
#include "render/range/io/elevation.h"
#include "render/range/io/words.h"

namespace merlin::render::range {
namespace {

constexpr std::string_view kMark = "MERLIN grid 1\n";
constexpr std::size_t kMostHead = std::size_t{4} << 20;  // limit of the head [bytes]
constexpr std::size_t kMostNotes = 16, kMostNote = 1000;

std::string textOf(std::string_view value) {
  return oneLine(wholeCharacters(value.substr(0, kMostNote)));
}

// Applies a line of the head. Returns an error message, or an empty text on success.
std::string setGridKey(std::string_view line, GridHead& head) {
  const std::size_t colon = std::min(line.find(':'), line.size());
  const std::string_view key = line.substr(0, colon);
  const std::string_view value = trimmed(line.substr(std::min(colon + 1, line.size())));
  if (key == "size") {
    std::string_view words = value;
    const bool read =
        readNumber(takeWord(words), head.width) && readNumber(takeWord(words), head.height);
    const bool fits = read && trimmed(words).empty() && head.width > 0 && head.height > 0 &&
                      head.width <= kMostPixels / head.height;
    return fits ? "" : fmt::format("size: found \"{}\"", oneLine(excerpt(value)));
  }
  if (key == "latitude") {
    double latitude = 0;
    if (!readNumber(value, latitude) || !(std::abs(latitude) <= 90))
      return fmt::format("latitude: found \"{}\"", oneLine(excerpt(value)));
    head.latitude_deg = latitude;
    return {};
  }
  if (key == "format") {
    head.format = oneLine(excerpt(value));
    return {};
  }
  if (key == "note") {
    if (head.notes.size() < kMostNotes) head.notes.push_back(textOf(value));
    return {};
  }
  const auto applied = applyLine(line, head.header);
  return applied ? std::string() : applied.error().what;
}

Result<GridHead> parseHead(std::string_view& bytes) {
  GridHead head;
  std::string_view rest = bytes.substr(0, kMostHead);
  const std::size_t whole = rest.size();
  takeLine(rest);
  for (std::size_t line = 2; !rest.empty(); ++line) {
    const std::string_view text = takeLine(rest);
    if (text == "values") {
      bytes.remove_prefix(whole - rest.size());
      if (head.width > 0) return head;
      return Error{Errc::kMalformed, "has no line size"};
    }
    if (const std::string fault = setGridKey(text, head); !fault.empty())
      return Error{Errc::kMalformed, fmt::format("line {}: {}", line, fault)};
  }
  return Error{Errc::kMalformed, "has no line values, which ends the head"};
}

// Converts the cell size to metres if it is in degrees, and adds a note.
void setMetres(const GridHead& head, StoredImage& image) {
  if (!head.latitude_deg || !image.header.cell) return;
  auto& cell = *image.header.cell;
  const auto metres = metresPerDegree(*head.latitude_deg);
  image.notes.push_back(
      fmt::format("cells of {:.6g} x {:.6g} degrees are taken as {:.2f} x {:.2f} m, as at latitude "
                  "{:.3f}",
                  cell[0], cell[1], cell[0] * metres[0], cell[1] * metres[1], *head.latitude_deg));
  cell = {cell[0] * metres[0], cell[1] * metres[1]};
}

}  // namespace

bool isGrid(std::string_view bytes) noexcept { return bytes.starts_with(kMark); }

Result<ParsedGrid> parseGrid(std::string_view bytes) {
  if (!isGrid(bytes)) return Error{Errc::kMalformed, "does not begin as a grid does"};
  auto head = parseHead(bytes);
  if (!head) return head.error();
  ParsedGrid grid;
  StoredImage& image = grid.image;
  image.width = head->width;
  image.height = head->height;
  const std::size_t pixels = image.width * image.height;
  if (bytes.size() != 4 * pixels)
    return Error{Errc::kMalformed,
                 fmt::format("has {} bytes of values; {} x {} take {}", bytes.size(), image.width,
                             image.height, 4 * pixels)};
  resizeHuge(image.values, pixels);
  const auto* p = reinterpret_cast<const std::uint8_t*>(bytes.data());
  for (std::size_t i = 0; i < pixels; ++i) image.values[i] = loadLeFloat(p + 4 * i);
  image.header = std::move(head->header);
  image.notes = std::move(head->notes);
  setMetres(*head, image);
  grid.format = std::move(head->format);
  return grid;
}

bool writeGrid(const GridHead& head, const WriteBytes& write, const ReadRow& read) {
  std::string text = fmt::format("{}size: {} {}\nformat: {}\n{}", kMark, head.width, head.height,
                                 textOf(head.format), linesOf(head.header, ""));
  if (head.latitude_deg) text += fmt::format("latitude: {}\n", *head.latitude_deg);
  for (const std::string& note : head.notes) text += fmt::format("note: {}\n", textOf(note));
  text += "values\n";
  if (!write(std::as_bytes(std::span(text)))) return false;
  std::vector<float> values(head.width);
  for (std::size_t row = 0; row < head.height; ++row) {
    if (!read(row, values)) return false;
    text.clear();
    for (const float value : values) appendLeFloat(text, value);
    if (!write(std::as_bytes(std::span(text)))) return false;
  }
  return true;
}

}  // namespace merlin::render::range
