#include "render/mesh/io/obj/obj_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace merlin::render::mesh {
namespace {

// A combination of vertex, texture coordinate and material that one or more corners have.
struct Wedge {
  std::uint32_t vertex, texcoord, material;
  bool operator==(const Wedge&) const = default;
};

// Numbers the wedges: the first wedge of each vertex has the index of the vertex; the others are
// appended after all vertices. The wedges of a vertex form a linked list of at most kLongest
// entries; further wedges are found through a map.
class Wedges {
 public:
  explicit Wedges(std::size_t vertices)
      : wedges_(vertices), next_(vertices, kEnd), used_(vertices, false) {
    for (std::uint32_t v = 0; v < vertices; ++v) wedges_[v] = {v, kNoTexcoord, 0};
  }

  std::uint32_t numberOf(const Wedge& wedge) {
    std::uint32_t at = wedge.vertex;
    if (!used_[at]) wedges_[at] = wedge;
    used_[at] = true;
    std::size_t length = 1;
    for (; wedges_[at] != wedge && next_[at] != kEnd; ++length) at = next_[at];
    if (wedges_[at] == wedge) return at;
    if (length < kLongest) return next_[at] = add(wedge);
    const auto key = std::array{wedge.vertex, wedge.texcoord, wedge.material};
    const auto [found, fresh] = others_.emplace(key, 0);
    if (fresh) found->second = add(wedge);
    return found->second;
  }

  std::vector<Wedge> take() { return std::move(wedges_); }

 private:
  static constexpr std::uint32_t kEnd = 0xFFFFFFFF;
  static constexpr std::size_t kLongest = 16;

  std::uint32_t add(const Wedge& wedge) {
    wedges_.push_back(wedge);
    next_.push_back(kEnd);
    return static_cast<std::uint32_t>(wedges_.size() - 1);
  }

  std::vector<Wedge> wedges_;
  std::vector<std::uint32_t> next_;
  std::vector<bool> used_;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> others_;
};

// Returns the wedges of a surface; `triangles` receives the index of each corner's wedge.
std::vector<Wedge> wedgesOf(const ObjSurface& surface, std::vector<std::uint32_t>& triangles) {
  Wedges wedges(surface.mesh.vertexCount());
  triangles.resize(surface.mesh.triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    triangles[i] = wedges.numberOf(
        {surface.mesh.triangles[i], surface.corner_texcoord[i], surface.triangle_material[i / 3]});
  }
  return wedges.take();
}

// Merges materials with the same content, so that there is no seam between them.
void mergeMaterials(ObjSurface& surface, const std::vector<ObjMaterial>& materials) {
  std::vector<std::uint32_t> same(materials.size());
  std::map<ObjMaterial, std::uint32_t> first;
  for (std::uint32_t m = 0; m < same.size(); ++m)
    same[m] = first.emplace(materials[m], m).first->second;
  for (std::uint32_t& m : surface.triangle_material) m = same[m];
}

// Returns the picture of each material, and for each triangle which one it shows. A triangle shows
// a picture only if all of its corners have texture coordinates.
SurfaceTextures texturesOf(const ObjSurface& surface, const std::vector<ObjMaterial>& materials) {
  SurfaceTextures all;
  for (const ObjMaterial& m : materials)
    all.textures.push_back({m.picture.get(), m.wrap(), m.wrap()});
  for (std::size_t t = 0; t < surface.triangle_material.size(); ++t) {
    const auto corners = std::span(surface.corner_texcoord).subspan(3 * t, 3);
    const std::uint32_t material = surface.triangle_material[t];
    const bool shown =
        materials[material].picture && std::ranges::find(corners, kNoTexcoord) == corners.end();
    all.of_triangle.push_back(shown ? material : kNoTexture);
  }
  return all;
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
    if (own_) {  // vertex colours are kept in addition to the texture, as in PLY files
      const float* c = &own_->values[3 * std::size_t{w.vertex}];
      return {c[0], c[1], c[2]};
    }
    const ObjMaterial& material = materials_[w.material];
    const auto [u, v] = texcoordOf(w);
    if (material.picture && w.texcoord != kNoTexcoord && std::isfinite(u) && std::isfinite(v))
      return material.picture->at(u, v, material.wrap(), material.wrap());
    return material.diffuse.value_or(std::array<float, 3>{1, 1, 1});
  }

 private:
  const ObjSurface& surface_;
  const std::vector<ObjMaterial>& materials_;
  const Feature* own_;
};

}  // namespace

TexturedSurface textured(ObjSurface surface, const std::vector<ObjMaterial>& materials) {
  if (surface.corner_texcoord.empty()) return {std::move(surface.mesh), {}};
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
  JoinedTextures joined = joinTextures(mesh, texturesOf(surface, materials));
  return {std::move(mesh), joined};
}

}  // namespace merlin::render::mesh
