#include "render/mesh/io/openmesh/stl_text.h"

#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "daemon/base/words.h"

namespace merlin::render::mesh {
namespace {

bool isCoordinate(std::string_view word) {
  double value = 0;
  return readNumber(word, value) && std::abs(value) <= double{std::numeric_limits<float>::max()};
}

class StlText {
 public:
  explicit StlText(std::string_view content) : left_(content) {}

  Result<std::size_t> check() {
    while (!left_.empty()) {
      ++line_;
      std::string_view line = takeLine(left_);
      const std::string_view word = takeWord(line);
      if (word.empty()) continue;
      if (const std::string fault = take(lowerCase(word), line); !fault.empty())
        return Error{Errc::kMalformed, fmt::format("line {}: {}", line_, fault)};
    }
    if (ended_) return facets_;
    return Error{
        Errc::kMalformed,
        fmt::format("cut short: the file ends without endsolid, after {} facets", facets_)};
  }

 private:
  // Returns an error message about the line, or an empty text if the line is correct.
  std::string take(const std::string& word, std::string_view line) {
    ended_ = word == "endsolid";
    if (word == "vertex") return takeVertex(line);
    if (word == "facet") return begin(in_facet_, "a facet begins within another one");
    if (word == "outer") return beginLoop();
    if (word == "endloop") return endLoop();
    if (word == "endfacet") return endFacet();
    if (ended_ && in_facet_) return "the solid ends within a facet";
    return {};
  }

  static std::string begin(bool& in, const char* fault) {
    if (in) return fault;
    in = true;
    return {};
  }

  std::string takeVertex(std::string_view line) {
    if (!in_loop_) return "a vertex is outside of a loop";
    ++vertices_;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string_view word = takeWord(line);
      if (word.empty()) return fmt::format("a vertex needs 3 coordinates, this one has {}", k);
      if (!isCoordinate(word)) return fmt::format("\"{}\" is not a coordinate", excerpt(word));
    }
    if (trimmed(line).empty()) return {};
    return fmt::format("\"{}\" follows the coordinates of a vertex", excerpt(trimmed(line)));
  }

  std::string beginLoop() {
    if (!in_facet_ || loops_ > 0) return "a facet needs one loop";
    ++loops_;
    vertices_ = 0;
    return begin(in_loop_, "a loop begins within another one");
  }

  std::string endLoop() {
    if (!in_loop_) return "a loop ends that has not begun";
    in_loop_ = false;
    if (vertices_ == 3) return {};
    return fmt::format("a loop needs 3 vertices, this one has {}", vertices_);
  }

  std::string endFacet() {
    if (!in_facet_ || in_loop_ || loops_ == 0) return "a facet ends without a whole loop";
    in_facet_ = false;
    loops_ = 0;
    ++facets_;
    return {};
  }

  std::string_view left_;
  std::size_t line_ = 0, facets_ = 0, loops_ = 0, vertices_ = 0;
  bool in_facet_ = false, in_loop_ = false;
  bool ended_ = false;  // whether the last non-empty line was endsolid
};

}  // namespace

bool isStlText(std::string_view content) {
  constexpr std::size_t kLooked = 4096;
  const std::string beginning = lowerCase(content.substr(0, kLooked));
  return beginning.starts_with("solid") && beginning.find("facet") != std::string::npos;
}

Result<std::size_t> checkStlText(std::string_view content) { return StlText(content).check(); }

}  // namespace merlin::render::mesh
