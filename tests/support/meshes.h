// Procedural meshes for the tests of render.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/random.h"
#include "render/mesh/mesh.h"

namespace merlin::test {

using render::mesh::Mesh;

// A grid of columns x rows unit cells in the plane z = 0, two triangles a cell, facing +z. Vertex
// (x, y) has the index y * (columns + 1) + x.
inline Mesh grid(std::uint32_t columns, std::uint32_t rows) {
  Mesh mesh;
  for (std::uint32_t y = 0; y <= rows; ++y) {
    for (std::uint32_t x = 0; x <= columns; ++x) {
      mesh.positions.insert(mesh.positions.end(),
                            {static_cast<float>(x), static_cast<float>(y), 0.0F});
    }
  }
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t a = y * (columns + 1) + x, b = a + 1, c = b + columns + 1, d = c - 1;
      mesh.triangles.insert(mesh.triangles.end(), {a, b, c, a, c, d});
    }
  }
  return mesh;
}

// The mesh of grid(), with normally distributed z of standard deviation `height`.
inline Mesh noisyGrid(std::uint32_t columns, std::uint32_t rows, double height,
                      std::uint64_t seed) {
  Mesh mesh = grid(columns, rows);
  Random random(seed);
  for (std::size_t i = 2; i < mesh.positions.size(); i += 3) {
    mesh.positions[i] = static_cast<float>(height * random.normal());
  }
  return mesh;
}

// A cube with 8 vertices at +-1 and 12 triangles. In a vertex index, bit 0 means x > 0, bit 1 y >
// 0, and bit 2 z > 0.
inline Mesh cube() {
  Mesh mesh;
  for (int v = 0; v < 8; ++v) {
    for (const int axis : {1, 2, 4}) mesh.positions.push_back(v & axis ? 1.0F : -1.0F);
  }
  mesh.triangles = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return mesh;
}

// Returns the mesh with each triangle split into four; the new vertices lie on the unit sphere.
inline Mesh subdivided(Mesh mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto fresh = static_cast<std::uint32_t>(mesh.vertexCount());
    const auto [at, made] = middles.try_emplace(std::minmax(a, b), fresh);
    if (!made) return at->second;
    float m[3];
    for (std::size_t k = 0; k < 3; ++k)
      m[k] = mesh.positions[3 * a + k] + mesh.positions[3 * b + k];
    const float length = std::hypot(m[0], m[1], m[2]);
    for (const float x : m) mesh.positions.push_back(x / length);
    return fresh;
  };
  const std::vector<std::uint32_t> coarse = std::exchange(mesh.triangles, {});
  for (std::size_t i = 0; i < coarse.size(); i += 3) {
    const std::uint32_t a = coarse[i], b = coarse[i + 1], c = coarse[i + 2];
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    mesh.triangles.insert(mesh.triangles.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
  }
  return mesh;
}

// A unit sphere, closed and manifold: an octahedron, subdivided `times` times, with 8 * 4^times
// triangles.
inline Mesh sphere(int times) {
  Mesh mesh;
  mesh.positions = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
  mesh.triangles = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  for (; times > 0; --times) mesh = subdivided(std::move(mesh));
  return mesh;
}

// A wavy tube, rolled up from a sheet. With `cut`, it has texture coordinates, and the vertices
// along the seam are doubled, since the coordinate there is 0 on one side and 1 on the other.
inline Mesh tube(std::uint32_t around, std::uint32_t high, bool cut) {
  Mesh mesh;
  const std::uint32_t columns = around + (cut ? 1 : 0);
  render::mesh::Feature texcoord{"texcoord", 2, {}};
  for (std::uint32_t row = 0; row <= high; ++row) {
    for (std::uint32_t c = 0; c < columns; ++c) {
      const double angle = 2 * std::numbers::pi * (c % around) / around, h = 0.05 * row;
      const double radius =
          1 + 0.1 * std::sin(5 * angle) * std::cos(3 * h) + 0.05 * std::cos(7 * h);
      mesh.positions.insert(mesh.positions.end(),
                            {static_cast<float>(radius * std::cos(angle)),
                             static_cast<float>(radius * std::sin(angle)), static_cast<float>(h)});
      texcoord.values.push_back(static_cast<float>(c) / static_cast<float>(around));
      texcoord.values.push_back(static_cast<float>(row) / static_cast<float>(high));
    }
  }
  const auto at = [&](std::uint32_t row, std::uint32_t c) { return row * columns + c % columns; };
  for (std::uint32_t row = 0; row < high; ++row) {
    for (std::uint32_t c = 0; c < around; ++c) {
      for (const std::uint32_t v : {at(row, c), at(row, c + 1), at(row + 1, c + 1)})
        mesh.triangles.push_back(v);
      for (const std::uint32_t v : {at(row, c), at(row + 1, c + 1), at(row + 1, c)})
        mesh.triangles.push_back(v);
    }
  }
  if (cut) mesh.features.push_back(std::move(texcoord));
  return mesh;
}

// Returns one mesh that has `a` and `b` as two components, without features.
inline Mesh together(Mesh a, const Mesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertexCount());
  a.features.clear();
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const std::uint32_t v : b.triangles) a.triangles.push_back(first + v);
  return a;
}

inline Mesh moved(Mesh mesh, float x, float y, float z) {
  const float by[] = {x, y, z};
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.positions[i] += by[i % 3];
  return mesh;
}

}  // namespace merlin::test
