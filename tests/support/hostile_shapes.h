// Meshes of any size that are hard to reduce, such as vertices or edges shared by very many
// triangles, and a regular grid for comparison.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "render/mesh/mesh.h"
#include "tests/support/meshes.h"

namespace merlin::test {

inline void addPoint(render::mesh::Mesh& mesh, double x, double y, double z) {
  for (const double c : {x, y, z}) mesh.positions.push_back(static_cast<float>(c));
}

// Adds `count` points around (x, 0, 0) in the plane z = 0, alternating between two radii.
inline void addRim(render::mesh::Mesh& mesh, std::size_t count, double x, double radius,
                   double other_radius) {
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const double r = i % 2 ? radius : other_radius;
    addPoint(mesh, x + r * std::cos(angle), r * std::sin(angle), 0);
  }
}

// Adds a triangle fan from vertex `hub` to the rim of `count` vertices that begins at `first`;
// `turned` reverses the triangles' winding.
inline void addFan(render::mesh::Mesh& mesh, std::size_t hub, std::size_t first, std::size_t count,
                   bool turned = false) {
  const auto h = static_cast<std::uint32_t>(hub);
  for (std::size_t i = 0; i < count; ++i) {
    const auto a = static_cast<std::uint32_t>(first + i);
    const auto b = static_cast<std::uint32_t>(first + (i + 1) % count);
    mesh.triangles.insert(mesh.triangles.end(), {h, turned ? b : a, turned ? a : b});
  }
}

inline render::mesh::Mesh regular(std::size_t triangles) {
  const auto side = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 2));
  return noisyGrid(side, side, 0.1, 1);
}

inline render::mesh::Mesh coneOf(std::size_t triangles, double height) {
  render::mesh::Mesh mesh;
  addPoint(mesh, 0, 0, height);
  addRim(mesh, triangles, 0, 1, 1);
  addFan(mesh, 0, 1, triangles);
  return mesh;
}

inline render::mesh::Mesh flatFan(std::size_t triangles) { return coneOf(triangles, 0); }
inline render::mesh::Mesh cone(std::size_t triangles) { return coneOf(triangles, 1); }

// A double pyramid: its two apexes are each shared by half of the triangles.
inline render::mesh::Mesh bipyramid(std::size_t triangles) {
  render::mesh::Mesh mesh;
  addPoint(mesh, 0, 0, 1);
  addPoint(mesh, 0, 0, -1);
  addRim(mesh, triangles / 2, 0, 1, 1);
  addFan(mesh, 0, 2, triangles / 2);
  addFan(mesh, 1, 2, triangles / 2, true);
  return mesh;
}

// A book: all triangles share one edge.
inline render::mesh::Mesh book(std::size_t triangles) {
  render::mesh::Mesh mesh;
  addPoint(mesh, 0, 0, -1);
  addPoint(mesh, 0, 0, 1);
  addRim(mesh, triangles, 0, 1, 1);
  for (std::uint32_t i = 0; i < triangles; ++i)
    mesh.triangles.insert(mesh.triangles.end(), {0, 1, 2 + i});
  return mesh;
}

// Flat stars of 2,000 triangles each; triangles fold over when a star's centre moves.
inline render::mesh::Mesh stars(std::size_t triangles) {
  constexpr std::size_t kEach = 2000;
  render::mesh::Mesh mesh;
  for (std::size_t k = 0; k < triangles / kEach; ++k) {
    const std::size_t hub = mesh.vertexCount();
    addPoint(mesh, 3 * static_cast<double>(k), 0, 0);
    addRim(mesh, kEach, 3 * static_cast<double>(k), 1, 0.3);
    addFan(mesh, hub, hub + 1, kEach);
  }
  return mesh;
}

// Random triangles between 300 vertices.
inline render::mesh::Mesh soup(std::size_t triangles) {
  constexpr std::uint32_t kVertices = 300;
  std::mt19937 random(1);
  const auto number = [&] { return static_cast<std::uint32_t>(random() % kVertices); };
  render::mesh::Mesh mesh;
  for (std::uint32_t v = 0; v < kVertices; ++v)
    addPoint(mesh, number() / 300.0, number() / 300.0, number() / 300.0);
  while (mesh.triangleCount() < triangles) {
    const std::uint32_t a = number(), b = number(), c = number();
    if (a != b && b != c && c != a) mesh.triangles.insert(mesh.triangles.end(), {a, b, c});
  }
  return mesh;
}

// A strip of very thin triangles, a million times longer than wide.
inline render::mesh::Mesh slivers(std::size_t triangles) {
  render::mesh::Mesh mesh;
  for (std::size_t i = 0; i <= triangles / 2; ++i) {
    addPoint(mesh, 1e-3 * static_cast<double>(i), 0, 0);
    addPoint(mesh, 1e-3 * static_cast<double>(i), 1000, 0);
  }
  for (std::uint32_t i = 0; i < triangles / 2; ++i) {
    const std::uint32_t a = 2 * i;
    mesh.triangles.insert(mesh.triangles.end(), {a, a + 2, a + 1, a + 1, a + 2, a + 3});
  }
  return mesh;
}

// A noisy grid whose coordinates are divided by 8 and rounded down, so that about 32
// vertices share each position.
inline render::mesh::Mesh coincident(std::size_t triangles) {
  render::mesh::Mesh mesh = regular(triangles);
  for (float& x : mesh.positions) x = std::floor(x / 8);
  return mesh;
}

struct HostileShape {
  const char* name;
  render::mesh::Mesh (*make)(std::size_t triangles);  // the count is approximate
};

inline std::vector<HostileShape> hostileShapes() {
  return {{"regular", regular}, {"fan", flatFan},         {"cone", cone},
          {"soup", soup},       {"bipyramid", bipyramid}, {"book", book},
          {"stars", stars},     {"slivers", slivers},     {"coincident", coincident}};
}

}  // namespace merlin::test
