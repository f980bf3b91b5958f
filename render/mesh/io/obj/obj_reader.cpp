// Reads OBJ files and the texture images of their materials: a row of the table of readers.
#include <algorithm>
#include <iterator>
#include <utility>

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
  std::vector<ObjMaterial> materials(surface->materials.size());
  if (!surface->corner_texcoord.empty()) {
    materials = readMaterials(surface->materials, surface->libraries, folder, loaded.notes);
  }
  TexturedSurface made = textured(*std::move(surface), materials);
  loaded.mesh = std::move(made.mesh);
  std::ranges::move(made.joined.notes(), std::back_inserter(loaded.notes));
  return loaded;
}

// Whether a line of a file can stand in an OBJ file, as far as its first word tells.
bool canBeObjLine(std::string_view word) {
  constexpr std::string_view kWords[] = {"v", "vt", "vn", "vp", "f",      "l",
                                         "p", "o",  "g",  "s",  "mtllib", "usemtl"};
  return word.empty() || std::ranges::find(kWords, word) != std::end(kWords);
}

// An OBJ file has no mark. Its first lines are such as OBJ has, and a vertex is among them.
bool isObj(std::string_view content) {
  constexpr std::size_t kLooked = std::size_t{1} << 16;
  const bool all = content.size() <= kLooked;
  content = content.substr(0, kLooked);
  bool vertex = false;
  while (!content.empty() && (all || content.find('\n') != std::string_view::npos)) {
    std::string_view line = takeUncommented(content);
    const std::string_view word = takeWord(line);
    if (!canBeObjLine(word)) return false;
    vertex = vertex || word == "v";
  }
  return vertex;
}

}  // namespace

const MeshReader kObjReader = {
    "obj",
    "colours; texture coordinates, and the texture images (PNG, JPEG) of its "
    "materials",
    read, nullptr, isObj};

}  // namespace merlin::render::mesh
