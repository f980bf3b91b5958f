#include "render/mesh/io/obj/obj.h"

#include <algorithm>
#include <array>
#include <optional>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "render/mesh/io/colour_range.h"
#include "render/mesh/io/text_lines.h"
#include "render/mesh/polygon.h"

namespace merlin::render::mesh {
namespace {

// A face corner such as "7/2/1", as indices from 0. A missing texture coordinate is kNoTexcoord;
// the normal is ignored.
struct ObjCorner {
  std::uint32_t vertex = 0, texcoord = kNoTexcoord;
};

// Returns the zero-based index for a number in the file, where 1 is the first element and -1 the
// last one so far. An invalid number becomes an index out of range, which checkCorners() rejects.
std::uint32_t indexOf(int number, std::size_t count) {
  const std::int64_t index =
      number > 0 ? std::int64_t{number} - 1 : static_cast<std::int64_t>(count) + number;
  return number == 0 || index < 0 ? 0xFFFFFFFF : static_cast<std::uint32_t>(index);
}

// The largest index of vertices or texture coordinates that corners refer to.
struct MaxIndex {
  std::uint32_t index = 0;
  int number = 0;  // as written in the file
  std::size_t line = 0;

  void take(std::uint32_t i, int as, std::size_t at) {
    if (line == 0 || i > index) *this = {i, as, at};
  }
  Result<Ok> check(const char* what, std::size_t count) const {
    if (line == 0 || index < count) return Ok{};
    return Error{Errc::kMalformed,
                 fmt::format("line {}: a corner refers to {} {}, but there are {}", line, what,
                             number, count)};
  }
};

constexpr std::size_t kFirstBlock = 4096;

// A keyword of lines with geometry that is not read, and its name for the note.
struct LeftOut {
  std::string_view keyword, what;
};
constexpr std::array<LeftOut, 6> kLeftOut = {{{"l", "lines"},
                                              {"p", "points"},
                                              {"curv", "curves"},
                                              {"curv2", "curves"},
                                              {"surf", "surfaces"},
                                              {"call", "other files"}}};

class ObjParser {
 public:
  explicit ObjParser(std::string_view content) : left_(content) {}

  Result<ObjSurface> parse() {
    // Rejects binary files, which may be large, before they are parsed.
    const std::size_t zero = left_.substr(0, kFirstBlock).find('\0');
    if (zero != std::string_view::npos)
      return Error{Errc::kMalformed, fmt::format("byte {} is 0: an OBJ file is text", zero)};
    surface_.materials = {""};
    while (!left_.empty()) {
      std::string_view line = nextLine();
      const std::string_view keyword = takeWord(line);
      if (const auto done = take(keyword, line); !done) return done.error();
    }
    if (const auto checked = checkCorners(); !checked) return checked.error();
    finish();
    return std::move(surface_);
  }

 private:
  // Returns whether the line continues on the next one, i.e. ends with a backslash. In lines that
  // hold a name, a backslash without a blank before it belongs to the name.
  static bool goesOn(std::string_view line) {
    if (!line.ends_with('\\')) return false;
    line.remove_suffix(1);
    if (line.empty() || line.ends_with(' ') || line.ends_with('\t')) return true;
    const std::string_view keyword = takeWord(line);
    return keyword == "v" || keyword == "vt" || keyword == "vn" || keyword == "f";
  }

  std::string_view nextLine() {
    const auto next = [&] {
      ++line_;
      return trimmed(takeUncommented(left_));
    };
    std::string_view line = next();
    if (!goesOn(line)) return line;
    joined_.clear();
    for (; line.ends_with('\\'); line = left_.empty() ? "" : next()) {
      joined_ += line.substr(0, line.size() - 1);
      joined_ += ' ';
    }
    joined_ += line;
    return joined_;
  }

  Error bad(std::string_view word, const char* what) const {
    return {Errc::kMalformed,
            fmt::format("line {}: \"{}\" is not a {}", line_, excerpt(word), what)};
  }

  Result<Ok> take(std::string_view keyword, std::string_view line) {
    if (keyword == "v") return takeVertex(line);
    if (keyword == "vt") return takeTexcoord(line);
    if (keyword == "f") return takeFace(line);
    if (keyword == "o") object_ = trimmed(line);
    if (keyword == "g") group_ = trimmed(line);
    if (keyword == "o" || keyword == "g") part_.reset();
    if (keyword == "usemtl") material_ = materialOf(std::string(trimmed(line)));
    if (keyword == "mtllib") surface_.libraries.emplace_back(trimmed(line));
    for (std::size_t i = 0; i < kLeftOut.size(); ++i)
      left_out_[i] += keyword == kLeftOut[i].keyword;
    return Ok{};
  }

  // Reads all numbers of the line and stores the first eight of them; returns how many it stored.
  Result<std::size_t> takeNumbers(std::string_view line, std::array<double, 8>& numbers) const {
    std::size_t count = 0;
    for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line)) {
      double value = 0;
      if (!readNumber(word, value)) return bad(word, "number");
      if (count < numbers.size()) numbers[count++] = value;
    }
    return count;
  }

  // Reads "x y z", "x y z w", or "x y z r g b".
  Result<Ok> takeVertex(std::string_view line) {
    std::array<double, 8> n{};
    const auto count = takeNumbers(line, n);
    if (!count) return count.error();
    if (*count < 3) {
      return Error{
          Errc::kMalformed,
          fmt::format("line {}: a vertex needs 3 coordinates, this one has {}", line_, *count)};
    }
    Mesh& mesh = surface_.mesh;
    if (mesh.positions.empty()) surface_.origin = originNear({n[0], n[1], n[2]});
    for (std::size_t k = 0; k < 3; ++k)
      mesh.positions.push_back(static_cast<float>(n[k] - surface_.origin[k]));
    for (std::size_t k = 3; k < 6 && *count >= 6; ++k) colours_.push_back(static_cast<float>(n[k]));
    return Ok{};
  }

  Result<Ok> takeTexcoord(std::string_view line) {
    std::array<double, 8> n{};
    const auto count = takeNumbers(line, n);
    if (!count) return count.error();
    if (*count < 1) {
      return Error{Errc::kMalformed,
                   fmt::format("line {}: a texture coordinate has no numbers", line_)};
    }
    for (std::size_t k = 0; k < 2; ++k) surface_.texcoords.push_back(static_cast<float>(n[k]));
    return Ok{};
  }

  Result<Ok> takeFace(std::string_view line) {
    ObjCorner first, last;
    std::size_t count = 0;
    for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line), ++count) {
      ObjCorner corner;
      if (!readCorner(word, corner)) return bad(word, "corner of a face");
      if (count == 0) first = corner;
      if (count >= 2) addTriangle({first, last, corner});
      last = corner;
    }
    if (count > 3) fans_.take(surface_.mesh, count);
    if (count >= 3) return Ok{};
    return Error{
        Errc::kMalformed,
        fmt::format("line {}: a face needs 3 corners or more, this one has {}", line_, count)};
  }

  // Reads a corner such as "7", "7/1", "7//2" or "-1/1/2".
  bool readCorner(std::string_view word, ObjCorner& corner) {
    const std::string_view vertex = word.substr(0, word.find('/'));
    int number = 0;
    if (!readNumber(vertex, number)) return false;
    corner.vertex = indexOf(number, surface_.mesh.vertexCount());
    vertices_.take(corner.vertex, number, line_);
    if (vertex.size() == word.size()) return true;
    word.remove_prefix(vertex.size() + 1);
    const std::string_view texcoord = word.substr(0, word.find('/'));
    if (texcoord.empty()) return true;
    if (!readNumber(texcoord, number)) return false;
    corner.texcoord = indexOf(number, surface_.texcoords.size() / 2);
    texcoords_.take(corner.texcoord, number, line_);
    textured_ = true;
    return true;
  }

  void addTriangle(const std::array<ObjCorner, 3>& corners) {
    for (const ObjCorner& c : corners) {
      surface_.mesh.triangles.push_back(c.vertex);
      surface_.corner_texcoord.push_back(c.texcoord);
    }
    surface_.triangle_material.push_back(material_);
    if (!part_) part_ = partNumber();
    surface_.triangle_part.push_back(*part_);
  }

  std::uint32_t partNumber() {
    const auto number = static_cast<std::uint32_t>(part_numbers_.size());
    return part_numbers_.emplace(object_ + '\0' + group_, number).first->second;
  }

  std::uint32_t materialOf(const std::string& name) {
    const auto number = static_cast<std::uint32_t>(surface_.materials.size());
    const auto [at, fresh] = material_numbers_.emplace(name, number);
    if (fresh) surface_.materials.push_back(name);
    return at->second;
  }

  // Checks that the corners' indices are in range. Called at the end, because vertices and texture
  // coordinates may follow the faces that use them.
  Result<Ok> checkCorners() const {
    const auto vertices = vertices_.check("vertex", surface_.mesh.vertexCount());
    return vertices ? texcoords_.check("texture coordinate", surface_.texcoords.size() / 2)
                    : vertices;
  }

  void finish() {
    Mesh& mesh = surface_.mesh;
    fans_.cut(mesh, [this](const Fan& fan, std::span<const std::uint32_t> order) {
      reorder(fan, order, surface_.corner_texcoord);
    });
    makeFractions(colours_);
    if (!colours_.empty() && colours_.size() == mesh.positions.size())
      mesh.features.push_back({"colour", 3, std::move(colours_)});
    noteLosses();
    surface_.parts = part_numbers_.size();
    if (surface_.parts < 2) surface_.triangle_part = {};
    if (textured_ || surface_.materials.size() > 1) return;
    surface_.corner_texcoord = {};
    surface_.triangle_material = {};
  }

  void noteLosses() {
    std::string list;
    for (std::size_t i = 0; i < kLeftOut.size(); ++i) {
      if (left_out_[i] > 0)
        list += fmt::format("{}{} {} ({})", list.empty() ? "" : ", ", left_out_[i],
                            kLeftOut[i].what, kLeftOut[i].keyword);
    }
    if (!list.empty()) surface_.notes.push_back("left out: " + list);
  }

  std::string_view left_;
  std::string joined_;  // the current line, if it was joined from several
  std::size_t line_ = 0;
  ObjSurface surface_;
  Fans fans_;
  std::array<std::size_t, kLeftOut.size()> left_out_{};  // number of lines of each kind in kLeftOut
  std::vector<float> colours_;
  std::unordered_map<std::string, std::uint32_t> material_numbers_{{"", 0}};
  std::uint32_t material_ = 0;
  std::string object_, group_;
  std::unordered_map<std::string, std::uint32_t> part_numbers_;
  std::optional<std::uint32_t>
      part_;  // Part number of the current object and group; nothing before their first triangle
  MaxIndex vertices_, texcoords_;
  bool textured_ = false;
};

}  // namespace

Result<ObjSurface> parseObj(std::string_view content) { return ObjParser(content).parse(); }

}  // namespace merlin::render::mesh
