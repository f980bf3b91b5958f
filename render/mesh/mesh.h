// Mesh: a triangulated surface with any number of named features per vertex, in flat arrays.
//
// A mesh is an indexed triangle set without stored adjacency. Non-manifold edges, borders and
// several components are all legal; an algorithm that cannot handle one of them states that in its
// contract. All functions are reentrant.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::mesh {

// One vertex attribute (a modality): `dimension` floats per vertex. Names with a meaning in MERLIN:
// "normal" (3, unit), "colour" (3, each 0..1, as stored in the file), "texcoord" (2). All other
// names are plain data.
struct Feature {
  std::string name;
  std::size_t dimension = 1;
  std::vector<float> values;  // vertices x dimension
};

struct Box {
  std::array<float, 3> low{}, high{};
  float diagonal() const noexcept;
};

struct Mesh {
  std::vector<float> positions;  // vertices x 3, model units
  std::vector<Feature> features;
  std::vector<std::uint32_t> triangles;  // triangles x 3: vertices, counter-clockwise from outside
  std::vector<std::uint8_t> texture{};   // texture image, a PNG or JPEG file; may be empty

  std::size_t vertexCount() const noexcept { return positions.size() / 3; }
  std::size_t triangleCount() const noexcept { return triangles.size() / 3; }

  // Nullptr if the mesh has no such feature.
  const Feature* find(std::string_view name) const noexcept;
  Feature* find(std::string_view name) noexcept;
};

// Counts of what tidy() removed.
struct TidyReport {
  std::size_t degenerate = 0;  // triangles with the same vertex twice
  std::size_t duplicate = 0;   // triangles with the same three vertices as an earlier one
  // Triangles with the same vertices as an earlier one, facing the other way.
  std::size_t opposite = 0;
  std::size_t unused = 0;  // vertices that no triangle uses
};

// Checks external data: every index in range, every number finite, coordinates within +-1e18, every
// feature of the right size, fewer than 2^31 vertices and triangles. Errors: kMalformed with the
// first violation; kUnsupported (too many vertices or triangles).
Result<Ok> validate(const Mesh& mesh);

// Drops triangles that have the same vertex twice, triangles with the same three vertices as an
// earlier triangle, and then vertices that no triangle uses. The order of the others is kept. O(n
// log n). REQUIRES: validate(mesh).ok().
TidyReport tidy(Mesh& mesh);

// Removes the vertices whose entry in `kept` is false; the order of the others is kept. Returns the
// number of removed vertices. REQUIRES: `kept` has one entry per vertex, true for each vertex of a
// triangle.
std::size_t keepVertices(Mesh& mesh, const std::vector<bool>& kept);

// Appends a copy of `vertex`, with its position and features; returns the index of the copy.
std::uint32_t addCopy(std::uint32_t vertex, Mesh& mesh);

// Returns the bounding box of all vertices; all zero if there are none.
Box boundingBox(std::span<const float> positions) noexcept;

// Returns the dot product of two vectors of three floats.
inline float dot(const float* a, const float* b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Returns the unit normal of the triangle with these corners (3 floats each); zero if its area is
// zero.
std::array<float, 3> faceNormal(const float* a, const float* b, const float* c) noexcept;

// Returns the vertex normals (vertices x 3): the mean of the unit normals of the faces at a vertex
// ([GOURLEY98] equation 4.1), scaled to unit length; zero if the face normals cancel.
std::vector<float> vertexNormals(const Mesh& mesh);

// Returns true if two coincident vertices belong to one smooth surface, i.e. their normals (of any
// length) form an angle below 90 degrees.
bool areOneSurface(const float* normal, const float* other) noexcept;

// Adds the feature "normal", computed by vertexNormals(), unless the mesh has normals of dimension
// 3 and unit length. In a mesh with texture coordinates, coincident vertices of one surface (the
// sides of a seam) get the same normal, so that shading does not show the seam; at a position with
// more than eight coincident vertices, each keeps its own normal.
void ensureNormals(Mesh& mesh);

}  // namespace merlin::render::mesh
