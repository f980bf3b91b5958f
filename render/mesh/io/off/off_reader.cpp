// Reads ASCII OFF files; defines a row of the table of readers.
#include <algorithm>
#include <array>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "render/mesh/io/colour_range.h"
#include "render/mesh/io/reader.h"
#include "render/mesh/io/text_lines.h"
#include "render/mesh/polygon.h"

namespace merlin::render::mesh {
namespace {

Error malformed(std::size_t line, const std::string& what) {
  return {Errc::kMalformed, fmt::format("line {}: {}", line, what)};
}

// The values that follow the coordinates of each vertex, as declared by the first word of the file.
struct Form {
  bool normal = false, colour = false, texcoord = false;
};

std::optional<Form> formOf(std::string_view keyword) {
  Form form;
  const auto take = [&keyword](std::string_view prefix) {
    if (!keyword.starts_with(prefix)) return false;
    keyword.remove_prefix(prefix.size());
    return true;
  };
  form.texcoord = take("ST");
  form.colour = take("C");
  form.normal = take("N");
  if (keyword != "OFF") return std::nullopt;
  return form;
}

class OffFile {
 public:
  explicit OffFile(std::string_view content) : rest_(content), bytes_(content.size()) {}

  // Parses the first word of the file and the numbers of vertices and faces.
  Result<Ok> header() {
    std::string_view line = nextLine();
    const std::string_view keyword = takeWord(line);
    const auto form = formOf(keyword);
    if (!form)
      return malformed(line_,
                       "does not begin with OFF, COFF, NOFF, STOFF or a combination of these");
    form_ = *form;
    if (trimmed(line) == "BINARY")
      return Error{Errc::kUnsupported, "is a binary OFF file; only ASCII is supported"};
    if (trimmed(line).empty()) line = nextLine();
    if (!readNumber(takeWord(line), vertices_) || !readNumber(takeWord(line), faces_))
      return malformed(line_, "lacks the numbers of vertices and faces");
    if (vertices_ > bytes_ || faces_ > bytes_)
      return malformed(line_, fmt::format("declares {} vertices and {} faces in a file of {} bytes",
                                          vertices_, faces_, bytes_));
    guessColours();
    return Ok{};
  }

  Result<Ok> body() {
    for (std::size_t i = 0; i < vertices_; ++i) {
      if (const auto added = addVertex(nextLine(), i); !added) return added;
    }
    for (std::size_t i = 0; i < faces_; ++i) {
      if (const auto added = addFace(nextLine(), i); !added) return added;
    }
    fans_.cut(mesh_);
    return Ok{};
  }

  LoadedMesh take() {
    LoadedMesh loaded;
    if (wrong_guess_)
      loaded.notes.push_back("left out: what follows the coordinates of the vertices");
    makeFractions(colour_.values);
    for (Feature* f : {&normal_, &colour_, &texcoord_}) {
      if (!f->values.empty()) mesh_.features.push_back(std::move(*f));
    }
    completeFacetColours(mesh_.triangleCount(), facet_colours_);
    if (unread_colours_ > 0)
      loaded.notes.push_back(fmt::format("left out: the colours of {} faces{}", unread_colours_,
                                         form_.colour ? ", since the vertices have colours" : ""));
    loaded.mesh = std::move(mesh_);
    loaded.facet_colours = std::move(facet_colours_);
    loaded.origin = origin_;
    return loaded;
  }
  MeshSize size() const {
    return {vertices_, faces_, std::size_t{form_.colour ? 3U : 0U} + (form_.texcoord ? 2U : 0U)};
  }

 private:
  // Guesses from the first vertex whether vertices have colours. Many programs write colours of
  // vertices without the C in the first word; they are treated as colours until a vertex lacks them
  // or has a negative one.
  void guessColours() {
    if (form_.colour || form_.texcoord || vertices_ == 0) return;
    const auto here = std::pair(rest_, line_);
    std::string_view ahead = nextLine();
    std::tie(rest_, line_) = here;
    std::size_t words = 0;
    while (!takeWord(ahead).empty()) ++words;
    const std::size_t known = form_.normal ? 6 : 3;
    guessed_ = form_.colour = words == known + 3 || words == known + 4;
  }

  bool takeGuess(std::string_view& line) {
    if (takeColour(line) &&
        std::all_of(colour_.values.end() - 3, colour_.values.end(), [](float c) { return c >= 0; }))
      return true;
    guessed_ = form_.colour = false;
    wrong_guess_ = true;
    colour_.values.clear();
    return true;
  }

  // Returns the next line that is neither blank nor a comment; empty at the end of the file.
  std::string_view nextLine() {
    while (!rest_.empty()) {
      const std::string_view line = trimmed(takeUncommented(rest_));
      ++line_;
      if (!line.empty()) return line;
    }
    return {};
  }

  bool take(std::string_view& line, std::size_t count, std::vector<float>& to) {
    for (std::size_t k = 0; k < count; ++k) {
      float value = 0;
      if (!readNumber(takeWord(line), value)) return false;
      to.push_back(value);
    }
    return true;
  }

  // Reads a position. Coordinates stay doubles until the origin, which is near the first vertex,
  // has been subtracted.
  bool takePosition(std::string_view& line) {
    std::array<double, 3> p{};
    for (double& x : p) {
      if (!readNumber(takeWord(line), x)) return false;
    }
    if (mesh_.positions.empty()) origin_ = originNear(p);
    for (std::size_t k = 0; k < 3; ++k)
      mesh_.positions.push_back(static_cast<float>(p[k] - origin_[k]));
    return true;
  }

  // Reads a colour of three or four numbers: integers 0 to 255, or fractions 0 to 1.
  bool takeColour(std::string_view& line) {
    if (colour_.values.empty()) {
      std::string_view ahead = line;
      std::size_t words = 0;
      for (; !takeWord(ahead).empty(); ++words) {
      }
      has_alpha_ = words == (form_.texcoord ? 6U : 4U);
    }
    if (!take(line, 3, colour_.values)) return false;
    return !has_alpha_ || !takeWord(line).empty();
  }

  Result<Ok> addVertex(std::string_view line, std::size_t i) {
    if (line.empty())
      return malformed(line_, fmt::format("the file ends after {} of {} vertices", i, vertices_));
    const bool whole = takePosition(line) && (!form_.normal || take(line, 3, normal_.values)) &&
                       (!form_.colour || (guessed_ ? takeGuess(line) : takeColour(line))) &&
                       (!form_.texcoord || take(line, 2, texcoord_.values));
    if (!whole)
      return malformed(line_, fmt::format("vertex {}: a number is missing or malformed", i));
    return Ok{};
  }

  // Takes the numbers after a face's corners (red, green, blue and possibly opacity) as the colour
  // of the last `triangles` triangles. A single number would be an index into a colour table, which
  // the file does not contain; it counts as unread.
  void takeFaceColour(std::string_view line, std::size_t triangles) {
    if (trimmed(line).empty()) return;
    std::vector<float> colour;
    if (form_.colour || !take(line, 3, colour)) {
      ++unread_colours_;
      return;
    }
    facet_colours_.resize(mesh_.triangles.size() - 3 * triangles, kNoColour);
    for (std::size_t t = 0; t < triangles; ++t)
      facet_colours_.insert(facet_colours_.end(), colour.begin(), colour.end());
  }

  // Adds a polygon as a triangle fan; body() later triangulates it differently if it is not convex.
  Result<Ok> addFace(std::string_view line, std::size_t i) {
    if (line.empty())
      return malformed(line_, fmt::format("the file ends after {} of {} faces", i, faces_));
    std::size_t corners = 0;
    if (!readNumber(takeWord(line), corners))
      return malformed(line_, fmt::format("face {}: the number of corners is missing", i));
    std::uint32_t first = 0, before = 0;
    for (std::size_t k = 0; k < corners; ++k) {
      std::uint32_t v = 0;
      if (!readNumber(takeWord(line), v))
        return malformed(line_, fmt::format("face {} has {} of {} corners", i, k, corners));
      if (v >= vertices_)
        return malformed(
            line_, fmt::format("face {} refers to vertex {}, but there are {}", i, v, vertices_));
      if (k == 0) first = v;
      if (k >= 2) mesh_.triangles.insert(mesh_.triangles.end(), {first, before, v});
      before = v;
    }
    if (corners > 3) fans_.take(mesh_, corners);
    takeFaceColour(line, corners > 2 ? corners - 2 : 0);
    return Ok{};
  }

  std::string_view rest_;
  std::size_t bytes_, line_ = 0;
  Form form_;
  std::size_t vertices_ = 0, faces_ = 0;
  bool has_alpha_ = false;
  bool guessed_ = false, wrong_guess_ = false;  // guess that vertices have colours; guess was wrong
  std::size_t unread_colours_ = 0;              // number of faces whose colours were not read
  std::vector<float> facet_colours_;            // up to the last face that has a colour
  Mesh mesh_;
  Fans fans_;
  Origin origin_{};  // offset subtracted from the positions
  Feature normal_{"normal", 3, {}}, colour_{"colour", 3, {}}, texcoord_{"texcoord", 2, {}};
};

Result<LoadedMesh> read(std::string_view content, const std::string&) {
  OffFile file(content);
  if (const auto header = file.header(); !header) return header.error();
  if (const auto body = file.body(); !body) return body.error();
  return file.take();
}

std::optional<MeshFileSize> size(std::string_view content, const std::string&) {
  OffFile file(content);
  if (!file.header()) return std::nullopt;
  return MeshFileSize{file.size()};
}

// Returns whether a file is OFF; skips comments before the first word.
bool isOff(std::string_view content) {
  constexpr std::size_t kLooked = 4096;
  content = content.substr(0, kLooked);
  while (!content.empty()) {
    std::string_view line = trimmed(takeUncommented(content));
    if (!line.empty()) return formOf(takeWord(line)).has_value();
  }
  return false;
}

}  // namespace

const MeshReader kOffReader = {
    "off",
    "ASCII: normals, texture coordinates, colours of vertices or faces; polygons "
    "become triangles",
    read, size, isOff};

}  // namespace merlin::render::mesh
