#include "render/points/io/xyz.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "daemon/base/words.h"

namespace merlin::render::points {
namespace {

constexpr std::string_view kBetween = " \t\r,;";
constexpr std::size_t kMostColumns = 7, kLookedAt = 4096, kLeastLines = 3;

struct Row {
  std::array<double, kMostColumns> numbers{};
  std::size_t count = 0;     // number of numbers; 0: a blank line or a comment
  std::string_view fault{};  // the first word that is not a number or is one too many
};

Row rowOf(std::string_view line) {
  Row row;
  line = trimmed(line, kBetween);
  if (line.starts_with('#') || line.starts_with("//")) return row;
  for (std::string_view word = takeWord(line, kBetween); !word.empty();
       word = takeWord(line, kBetween)) {
    if (word.starts_with('+')) word.remove_prefix(1);
    if (row.count == kMostColumns || !readNumber(word, row.numbers[row.count])) {
      row.fault = word.empty() ? "+" : word;
      return row;
    }
    ++row.count;
  }
  return row;
}

bool isColumnCount(std::size_t n) { return n == 3 || n == 4 || n == 6 || n == 7; }

// Returns whether the line is a number of points, with which PTS files begin.
bool isPointCount(const Row& row) {
  return row.count == 1 && row.numbers[0] >= 0 && row.numbers[0] == std::floor(row.numbers[0]);
}

class XyzReader {
 public:
  explicit XyzReader(std::string_view text) : text_(text) {}

  Result<PointCloud> read() {
    for (std::size_t line = 1; !text_.empty(); ++line) {
      const Row row = rowOf(takeLine(text_));
      if (row.fault.empty() && (row.count == 0 || (columns_ == 0 && isPointCount(row)))) continue;
      if (const auto added = add(row, line); !added) return added.error();
    }
    if (columns_ == 0) return Error{Errc::kMalformed, "has no points"};
    cloud_.format = "XYZ text";
    if (const auto good = addExtra(); !good) return good.error();
    return std::move(cloud_);
  }

 private:
  Result<Ok> add(const Row& row, std::size_t line) {
    if (!row.fault.empty())
      return Error{Errc::kMalformed, fmt::format("line {}: \"{}\" is not a number of a point", line,
                                                 oneLine(excerpt(row.fault)))};
    if (columns_ == 0) {
      columns_ = row.count;
      cloud_.origin = mesh::originNear({row.numbers[0], row.numbers[1], row.numbers[2]});
    }
    if (row.count != columns_ || !isColumnCount(columns_))
      return Error{Errc::kMalformed,
                   fmt::format("line {}: has {} numbers; {}", line, row.count,
                               row.count == columns_ ? "a point has 3, 4, 6 or 7"
                                                     : "the lines before have a different number")};
    if (cloud_.size() == kMostPoints)
      return Error{Errc::kUnsupported, fmt::format("has more than {} points", kMostPoints)};
    for (std::size_t k = 0; k < 3; ++k)
      cloud_.positions.push_back(static_cast<float>(row.numbers[k] - cloud_.origin[k]));
    for (std::size_t k = 3; k < columns_; ++k) extra_.push_back(static_cast<float>(row.numbers[k]));
    return Ok{};
  }

  // Returns a feature made of `width` columns; `first`: index of its first column, counted after x,
  // y and z.
  mesh::Feature columnsOf(const char* name, std::size_t first, std::size_t width) const {
    mesh::Feature feature{name, width, {}};
    feature.values.reserve(cloud_.size() * width);
    for (std::size_t p = 0; p < cloud_.size(); ++p) {
      for (std::size_t k = 0; k < width; ++k)
        feature.values.push_back(extra_[p * (columns_ - 3) + first + k]);
    }
    return feature;
  }

  Result<Ok> addExtra() {
    if (columns_ == 4 || columns_ == 7) cloud_.features.push_back(columnsOf("intensity", 0, 1));
    if (columns_ < 6) return Ok{};
    mesh::Feature three = columnsOf("colour", columns_ - 6, 3);
    const auto byte = [](float v) { return v >= 0 && v <= 255 && v == std::floor(v); };
    if (std::ranges::all_of(three.values, byte)) {
      for (float& v : three.values) v /= 255;
    } else if (columns_ == 6 && areNormals(three.values)) {
      three.name = "normal";
    } else {
      return Error{Errc::kMalformed,
                   "its last three columns are neither colours (whole numbers from 0 to 255) nor, "
                   "if there are six columns, normals (of length 1)"};
    }
    cloud_.features.push_back(std::move(three));
    return Ok{};
  }

  static bool areNormals(const std::vector<float>& values) {
    for (std::size_t i = 0; i < values.size(); i += 3)
      if (!(std::abs(mesh::dot(&values[i], &values[i]) - 1) <= 0.1F)) return false;
    return true;
  }

  std::string_view text_;
  std::size_t columns_ = 0;
  PointCloud cloud_;
  std::vector<float> extra_;
};

}  // namespace

bool isXyz(std::string_view bytes) {
  std::string_view text = bytes.substr(0, kLookedAt);
  // Keeps whole lines only.
  if (bytes.size() > kLookedAt) text = text.substr(0, text.rfind('\n') + 1);
  std::size_t columns = 0, points = 0;
  while (!text.empty()) {
    const Row row = rowOf(takeLine(text));
    if (!row.fault.empty()) return false;
    if (row.count == 0 || (columns == 0 && isPointCount(row))) continue;
    if (columns == 0) columns = row.count;
    if (row.count != columns || !isColumnCount(columns)) return false;
    ++points;
  }
  return points >= kLeastLines;
}

Result<PointCloud> parseXyz(std::string_view bytes) { return XyzReader(bytes).read(); }

}  // namespace merlin::render::points
