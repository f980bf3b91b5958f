#include "render/mesh/io/ply/ply_rows.h"

#include <fmt/format.h>

#include "daemon/base/words.h"

namespace merlin::render::mesh::ply {
namespace {

// Removes the words of a row's properties from `line`. Returns their number, or 0 if the line has
// fewer words.
std::size_t takeRow(std::string_view& line, const Element& element) {
  std::size_t words = 0;
  for (const Property& p : element.properties) {
    std::size_t count = 1;
    if (p.list) {
      ++words;
      if (!readNumber(takeWord(line), count)) return 0;
    }
    for (; count > 0; --count, ++words) {
      if (takeWord(line).empty()) return 0;
    }
  }
  return words;
}

}  // namespace

std::string longRow(std::string_view body, const Header& header) {
  for (const Element& element : header.elements) {
    for (std::uint64_t row = 0; row < element.count && !element.properties.empty(); ++row) {
      std::string_view line = takeLine(body);
      const std::size_t promised = takeRow(line, element);
      if (promised == 0) return {};
      const std::size_t more = wordsIn(line);
      if (more > 0)
        return fmt::format("{} {} has {} numbers in its line, but {} by the header", element.name,
                           row, promised + more, promised);
    }
  }
  return {};
}

}  // namespace merlin::render::mesh::ply
