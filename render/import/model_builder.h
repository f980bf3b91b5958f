// ModelBuilder: collects the triangles of all parts of a model in one mesh.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "render/image/image_file.h"
#include "render/mesh/atlas/join_textures.h"
#include "render/mesh/mesh.h"
#include "render/mesh/origin.h"
#include "render/mesh/weld_parts.h"

namespace merlin::render::import {

// Colour of surfaces to which the file gives no colour.
inline constexpr std::array<float, 3> kPlain{0.8F, 0.8F, 0.8F};

// A corner of a triangle: position in the model's coordinates; colour as displayed on a screen,
// each component 0..1; texture coordinates with v upwards.
struct Corner {
  std::array<float, 3> position{};
  std::array<float, 3> colour = kPlain;
  std::array<float, 2> texcoord{};
  std::uint32_t row = 0;  // index into the values of takeValues()
};

struct BuiltModel {
  mesh::Mesh mesh;
  mesh::Origin origin{};       // offset that was subtracted from the file's coordinates
  std::size_t parts = 0;       // number of parts that have triangles
  std::size_t degenerate = 0;  // number of dropped triangles with two corners at one vertex
  std::size_t not_finite = 0;  // number of dropped triangles with a coordinate that is NaN or huge
  mesh::WeldReport welded;     // report of welding different parts
  std::vector<std::string> notes;
};

// Corners of one part become one vertex if all their values and rows are equal; so seams of
// textures and borders between colours are kept. Vertices of different parts are welded where the
// parts are one surface (render/mesh/weld_parts.h). Pure, but may throw std::bad_alloc.
// Thread-bound.
class ModelBuilder {
 public:
  // Takes additional features of the vertices; Corner::row selects the row of each corner. They
  // replace features of the same name that finish() would make. REQUIRES: called before add();
  // every feature has all rows to which corners refer.
  void takeValues(std::vector<mesh::Feature> values) { values_ = std::move(values); }
  // Begins a new part; triangles that are added after this call belong to it. `texture`: its image
  // must outlive the builder; a null image means no texture.
  void beginPart(const mesh::SurfaceTexture& texture);
  // Adds a triangle, counter-clockwise from outside. If the part has a texture, the texture's
  // colour at a corner replaces the corner's colour.
  void add(std::array<Corner, 3> corners);

  std::size_t triangles() const noexcept { return model_.mesh.triangleCount(); }

  // Returns the mesh and its report. The mesh has "colour" if a part has a colour or a texture,
  // "texcoord" if a part has a texture, "label" (the part's number from 0) if there are several
  // parts, and one joint texture if any part has one (render/mesh/atlas).
  BuiltModel finish() &&;

 private:
  using Key = std::array<std::uint32_t, 9>;
  struct Hash {
    std::size_t operator()(const Key& key) const noexcept;
  };
  std::uint32_t vertexOf(const Corner& corner);
  void dress(Corner& corner) const;
  std::uint32_t textureNumber();
  void addValues();

  BuiltModel model_;
  std::vector<float> colours_, texcoords_, labels_;
  std::vector<mesh::Feature> values_;  // from takeValues()
  std::vector<std::uint32_t> rows_;    // by vertex: its row of values_; empty if there are none
  std::unordered_map<Key, std::uint32_t, Hash> vertices_;  // vertices of the current part
  mesh::SurfaceTexture texture_;                           // texture of the current part
  std::uint32_t number_ = mesh::kNoTexture;                // index of texture_ in textures_
  // Textures of the parts that have triangles.
  mesh::SurfaceTextures textures_;
  bool part_has_triangles_ = false, coloured_ = false;
};

}  // namespace merlin::render::import
