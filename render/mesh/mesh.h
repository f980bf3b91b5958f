// Mesh: a triangulated surface with any number of named features at its vertices. Flat arrays.
//
// A triangle soup with shared vertices: non-manifold edges, borders and several components are all
// legal here; what an algorithm cannot take it says. Reentrant.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render {

// One modality: `dimension` floats a vertex. Names that MERLIN gives a meaning to: "normal" (3,
// unit), "colour" (3, each 0..1, as stored in the file), "texcoord" (2). Any other is data.
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
  std::vector<std::uint32_t> triangles;  // triangles x 3, vertex indices, counter-clockwise outside
  std::vector<std::uint8_t> texture{};   // the picture of "texcoord", a PNG or JPEG file; or none

  std::size_t vertexCount() const noexcept { return positions.size() / 3; }
  std::size_t triangleCount() const noexcept { return triangles.size() / 3; }

  const Feature* find(std::string_view name) const noexcept;  // nullptr if there is none
  Feature* find(std::string_view name) noexcept;
};

// Counts of what tidy() removed.
struct TidyReport {
  std::size_t degenerate = 0;  // triangles with a vertex twice
  std::size_t duplicate = 0;   // triangles of the same three vertices as one before
  std::size_t opposite = 0;    // the same, but facing the other way
  std::size_t unused = 0;      // vertices of no triangle
};

// Checks what comes from outside: every index in range, every number finite, coordinates within
// +-1e18, every feature of the right size, fewer than 2^31 vertices and triangles. Errors:
// kMalformed, with the first offender.
Result<Ok> validate(const Mesh& mesh);

// Drops triangles that have a vertex twice, triangles of the same three vertices as one before,
// then vertices that no triangle uses. Order is kept. O(n log n). REQUIRES: validate(mesh).ok().
TidyReport tidy(Mesh& mesh);

// Bounding box of all vertices; zero for a mesh without any.
Box boundingBox(std::span<const float> positions) noexcept;

// Dot product of two vectors of three.
inline float dot(const float* a, const float* b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Unit normal of the triangle with these corners; zero where it has no area.
std::array<float, 3> faceNormal(const float* a, const float* b, const float* c) noexcept;

// Vertex normals, the mean of the unit normals of a vertex' faces (equation 4.1), scaled to unit
// length; zero where they cancel. vertices x 3.
std::vector<float> vertexNormals(const Mesh& mesh);

// Whether the two sides of a seam, of which these are normals of any length, are one surface: what
// faces away is another's.
bool areOneSurface(const float* normal, const float* other) noexcept;

// Adds "normal" by vertexNormals() unless the mesh has one of the right size and unit length. Where
// there are texture coordinates all sides of a seam that are one surface get the same, so that it
// is not seen in the light (where more than eight vertices lie in one place each has its own).
void ensureNormals(Mesh& mesh);

}  // namespace merlin::render
