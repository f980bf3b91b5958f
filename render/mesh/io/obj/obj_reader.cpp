// Reads OBJ files and the texture images of their materials: a row of the table of readers.
#include <algorithm>
#include <utility>

#include "render/mesh/io/obj/obj_texture.h"
#include "render/mesh/io/reader.h"

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
  loaded.mesh = textured(*std::move(surface), materials);
  const bool pictures =
      std::ranges::any_of(materials, [](const ObjMaterial& m) { return m.picture != nullptr; });
  if (pictures && loaded.mesh.texture.empty())
    loaded.notes.emplace_back(
        "several textures, a clamped one, or faces without one: baked into vertex colours");
  return loaded;
}

}  // namespace

const MeshReader kObjReader = {
    "obj",
    "colours; texture coordinates, and the texture images (PNG, JPEG) of its "
    "materials",
    read};

}  // namespace merlin::render::mesh
