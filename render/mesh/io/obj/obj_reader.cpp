// Reads OBJ files and the texture images of their materials; defines a row of the table of readers.
#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "render/mesh/io/obj/obj_parts.h"
#include "render/mesh/io/obj/obj_texture.h"
#include "render/mesh/io/reader.h"
#include "render/mesh/io/text_lines.h"

namespace merlin::render::mesh {
namespace {

Result<LoadedMesh> read(std::string_view content, const std::string& folder) {
  auto surface = parseObj(content);
  if (!surface) return surface.error();
  if (const auto valid = validate(surface->mesh); !valid) return valid.error();
  LoadedMesh loaded;
  loaded.origin = surface->origin;
  loaded.notes = std::move(surface->notes);
  std::vector<ObjMaterial> materials(surface->materials.size());
  if (!surface->corner_texcoord.empty()) {
    materials = readMaterials(surface->materials, surface->libraries, folder, loaded.notes);
  }
  const std::vector<std::uint32_t> part_of = std::move(surface->triangle_part);
  const std::size_t parts = surface->parts;
  TexturedSurface made = textured(*std::move(surface), materials);
  loaded.mesh = std::move(made.mesh);
  if (!part_of.empty()) {
    labelParts(part_of, loaded.mesh);
    loaded.notes.push_back(fmt::format(
        "its {} objects and groups become one mesh; the feature label has the number of each, from "
        "0 in the order of the file",
        parts));
  }
  std::ranges::move(made.joined.notes(), std::back_inserter(loaded.notes));
  return loaded;
}

// Counts the elements of an OBJ file line by line; keeps only names.
class ObjCounts {
 public:
  explicit ObjCounts(std::string_view content) {
    while (!content.empty()) count(takeLine(content));
  }

  // Estimates the size and the memory. While a file is read, the corners of triangles are kept
  // twice and vectors grow to twice their size; a vertex at a texture seam becomes several
  // vertices.
  MeshFileSize size(const std::string& folder) const {
    const bool dressed = texcoords_ > 0 || names_.size() > 1;
    MeshFileSize size;
    size.mesh.vertices = std::max(vertices_, texcoords_);
    size.mesh.triangles = triangles_;
    size.mesh.values = (coloured_ || names_.size() > 1 ? 3U : 0U) + (texcoords_ > 0 ? 2U : 0U);
    size.meanwhile = 64 * triangles_ + 24 * vertices_ + 16 * texcoords_ +
                     (dressed ? 20 * size.mesh.vertices : 0);
    size.pictures = picturesOf({names_.begin(), names_.end()}, libraries_, folder);
    return size;
  }

 private:
  void count(std::string_view line) {
    const std::string_view word = takeWord(line);
    if (word == "v") {
      coloured_ = coloured_ || (vertices_ == 0 && wordsIn(line) >= 6);
      ++vertices_;
    } else if (word == "vt") {
      ++texcoords_;
    } else if (word == "f") {
      triangles_ += std::max(wordsIn(line), std::size_t{2}) - 2;
    } else if (word == "usemtl") {
      names_.emplace(trimmed(line.substr(0, line.find('#'))));
    } else if (word == "mtllib") {
      libraries_.emplace_back(trimmed(line.substr(0, line.find('#'))));
    }
  }

  std::size_t vertices_ = 0, texcoords_ = 0, triangles_ = 0;
  bool coloured_ = false;
  std::set<std::string, std::less<>> names_{""};
  std::vector<std::string> libraries_;
};

std::optional<MeshFileSize> size(std::string_view content, const std::string& folder) {
  return ObjCounts(content).size(folder);
}

// Returns whether a line can belong to an OBJ file, judged by its first word.
bool canBeObjLine(std::string_view word) {
  constexpr std::string_view kWords[] = {"v", "vt", "vn", "vp", "f",      "l",
                                         "p", "o",  "g",  "s",  "mtllib", "usemtl"};
  return word.empty() || std::ranges::find(kWords, word) != std::end(kWords);
}

// Returns whether a file is OBJ. Since OBJ files have no magic number, all of the first lines must
// be lines of OBJ, with a vertex among them.
bool isObj(std::string_view content) {
  constexpr std::size_t kLooked = std::size_t{1} << 16;
  const bool all = content.size() <= kLooked;
  content = content.substr(0, kLooked);
  bool vertex = false, continued = false;
  while (!content.empty() && (all || content.find('\n') != std::string_view::npos)) {
    std::string_view line = takeUncommented(content);
    const bool goes_on = std::exchange(continued, trimmed(line).ends_with('\\'));
    const std::string_view word = takeWord(line);
    if (!goes_on && !canBeObjLine(word)) return false;
    vertex = vertex || word == "v";
  }
  return vertex;
}

}  // namespace

const MeshReader kObjReader = {
    "obj",
    "colours; texture coordinates, and the texture images (PNG, JPEG) of its "
    "materials",
    read, size, isObj};

}  // namespace merlin::render::mesh
