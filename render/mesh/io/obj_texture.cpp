#include "render/mesh/io/obj_texture.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace merlin::render {
namespace {

// A vertex as corners see it.
struct Wedge {
  std::uint32_t vertex, texcoord, material;
  bool operator==(const Wedge&) const = default;
};

// The first wedge of each vertex has the vertex' number, the others stand behind all of them;
// `triangles` then holds wedges. Those of one vertex are a chain: linear but for vertices with
// many.
std::vector<Wedge> wedgesOf(const ObjSurface& surface, std::vector<std::uint32_t>& triangles) {
  constexpr std::uint32_t kEnd = 0xFFFFFFFF;
  const std::size_t vertices = surface.mesh.vertexCount();
  std::vector<Wedge> wedges(vertices);
  std::vector<std::uint32_t> next(vertices, kEnd);
  std::vector<bool> used(vertices, false);
  for (std::uint32_t v = 0; v < vertices; ++v) wedges[v] = {v, kNoTexcoord, 0};
  triangles.resize(surface.mesh.triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t v = surface.mesh.triangles[i];
    const Wedge wedge{v, surface.corner_texcoord[i], surface.triangle_material[i / 3]};
    if (!used[v]) wedges[v] = wedge;
    used[v] = true;
    std::uint32_t at = v;
    while (wedges[at] != wedge && next[at] != kEnd) at = next[at];
    if (wedges[at] != wedge) {
      at = next[at] = static_cast<std::uint32_t>(wedges.size());
      wedges.push_back(wedge);
      next.push_back(kEnd);
    }
    triangles[i] = at;
  }
  return wedges;
}

// Materials that look the same are one: no seam runs between them.
void mergeMaterials(ObjSurface& surface, const std::vector<ObjMaterial>& materials) {
  std::vector<std::uint32_t> same(materials.size());
  for (std::size_t m = 0; m < same.size(); ++m) {
    const auto at = std::find(materials.begin(), materials.end(), materials[m]);
    same[m] = static_cast<std::uint32_t>(at - materials.begin());
  }
  for (std::uint32_t& m : surface.triangle_material) m = same[m];
}

// That of every corner, if there is one, and if it repeats as a texture does.
const PictureFile* onlyPicture(const ObjSurface& surface,
                               const std::vector<ObjMaterial>& materials) {
  const auto& used = surface.triangle_material;
  if (used.empty() || std::ranges::count(surface.corner_texcoord, kNoTexcoord) > 0) return nullptr;
  const PictureFile* picture = materials[used[0]].picture.get();
  const bool everywhere = std::ranges::all_of(used, [&](std::uint32_t m) {
    return materials[m].picture.get() == picture && !materials[m].clamped;
  });
  return everywhere ? picture : nullptr;
}

class Dresser {
 public:
  Dresser(const ObjSurface& surface, const std::vector<ObjMaterial>& materials)
      : surface_(surface), materials_(materials), own_(surface.mesh.find("colour")) {}

  bool hasColours() const {
    return own_ || std::any_of(materials_.begin(), materials_.end(),
                               [](const ObjMaterial& m) { return m.picture || m.diffuse; });
  }

  std::array<float, 2> texcoordOf(const Wedge& w) const {
    if (w.texcoord == kNoTexcoord) return {};
    return {surface_.texcoords[2 * std::size_t{w.texcoord}],
            surface_.texcoords[2 * std::size_t{w.texcoord} + 1]};
  }

  std::array<float, 3> colourOf(const Wedge& w) const {
    const ObjMaterial& material = materials_[w.material];
    const auto [u, v] = texcoordOf(w);
    if (material.picture && w.texcoord != kNoTexcoord && std::isfinite(u) && std::isfinite(v))
      return material.picture->at(u, v, material.clamped);
    if (own_) {
      const float* c = &own_->values[3 * std::size_t{w.vertex}];
      return {c[0], c[1], c[2]};
    }
    return material.diffuse.value_or(std::array<float, 3>{1, 1, 1});
  }

 private:
  const ObjSurface& surface_;
  const std::vector<ObjMaterial>& materials_;
  const Feature* own_;
};

}  // namespace

Mesh textured(ObjSurface surface, const std::vector<ObjMaterial>& materials) {
  if (surface.corner_texcoord.empty()) return std::move(surface.mesh);
  mergeMaterials(surface, materials);
  Mesh mesh;
  const std::vector<Wedge> wedges = wedgesOf(surface, mesh.triangles);
  const Dresser dresser(surface, materials);
  Feature texcoord{"texcoord", 2, {}}, colour{"colour", 3, {}};
  mesh.positions.reserve(3 * wedges.size());
  for (const Wedge& w : wedges) {
    const float* p = &surface.mesh.positions[3 * std::size_t{w.vertex}];
    mesh.positions.insert(mesh.positions.end(), p, p + 3);
    const auto uv = dresser.texcoordOf(w);
    texcoord.values.insert(texcoord.values.end(), uv.begin(), uv.end());
    if (!dresser.hasColours()) continue;
    const auto c = dresser.colourOf(w);
    colour.values.insert(colour.values.end(), c.begin(), c.end());
  }
  if (dresser.hasColours()) mesh.features.push_back(std::move(colour));
  if (!surface.texcoords.empty()) mesh.features.push_back(std::move(texcoord));
  if (const PictureFile* picture = onlyPicture(surface, materials)) mesh.texture = picture->file;
  return mesh;
}

}  // namespace merlin::render
