// Computes normals of faces and vertices; declared in mesh.h.
#include <algorithm>
#include <cmath>
#include <utility>

#include "render/mesh/coincident.h"
#include "render/mesh/mesh.h"

namespace merlin::render::mesh {
namespace {

constexpr std::size_t kMostSides = 8;  // more coincident vertices are not treated as a seam

void normalise(float* v) noexcept {
  const float length = std::sqrt(dot(v, v));
  for (int k = 0; k < 3; ++k) v[k] = length > 0 ? v[k] / length : 0;
}

bool areUnit(const std::vector<float>& normals) {
  for (std::size_t i = 0; i < normals.size(); i += 3) {
    if (!(std::abs(dot(&normals[i], &normals[i]) - 1) < 0.01F)) return false;
  }
  return true;
}

// Returns for each vertex the sum of its faces' unit normals.
std::vector<float> normalSums(const Mesh& mesh) {
  std::vector<float> normals(mesh.positions.size(), 0.0F);
  const float* p = mesh.positions.data();
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const std::uint32_t* t = &mesh.triangles[i];
    const auto f =
        faceNormal(p + 3 * std::size_t{t[0]}, p + 3 * std::size_t{t[1]}, p + 3 * std::size_t{t[2]});
    for (int corner = 0; corner < 3; ++corner) {
      for (std::size_t k = 0; k < 3; ++k) normals[3 * std::size_t{t[corner]} + k] += f[k];
    }
  }
  return normals;
}

// Replaces the normal sums of coincident vertices by the sum over their group: vertices are in one
// group if areOneSurface() holds for them, directly or through others.
void joinSides(const std::vector<std::uint32_t>& sides, std::vector<float>& sums) {
  const auto of = [&](std::size_t side) { return &sums[3 * std::size_t{sides[side]}]; };
  std::array<std::size_t, kMostSides> group{};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    group[i] = i;
    for (std::size_t k = 0; k < i; ++k) {
      const std::size_t other = group[k];
      if (areOneSurface(of(i), of(k))) std::ranges::replace(group, other, i);
    }
  }
  std::array<std::array<float, 3>, kMostSides> joined{};
  const auto addThose = [&](std::size_t i, const auto& are) {
    joined[i] = {};
    for (std::size_t o = 0; o < sides.size(); ++o) {
      for (std::size_t k = 0; are(o) && k < 3; ++k) joined[i][k] += of(o)[k];
    }
  };
  for (std::size_t i = 0; i < sides.size(); ++i) {
    addThose(i, [&](std::size_t o) { return group[o] == group[i]; });
    // Blades around an axis form a group too, but their normals cancel. In this case, only those
    // sides are added that form one surface with side i directly.
    if (dot(joined[i].data(), of(i)) < 0.5F * dot(of(i), of(i)))
      addThose(i, [&](std::size_t o) { return o == i || areOneSurface(of(i), of(o)); });
  }
  for (std::size_t i = 0; i < sides.size(); ++i) std::ranges::copy(joined[i], of(i));
}

void joinSeams(const Mesh& mesh, std::vector<float>& sums) {
  const std::vector<std::uint32_t> next = coincidentVertices(mesh.positions);
  std::vector<std::uint32_t> sides;
  for (std::uint32_t v = 0; v < next.size(); ++v) {
    sides.assign(1, v);
    bool first = true;  // v has the smallest index at its position
    for (std::uint32_t o = next[v]; o != v && first && sides.size() <= kMostSides; o = next[o]) {
      first = o > v;
      sides.push_back(o);
    }
    if (first && sides.size() > 1 && sides.size() <= kMostSides) joinSides(sides, sums);
  }
}

void normaliseAll(std::vector<float>& normals) {
  for (std::size_t i = 0; i < normals.size(); i += 3) normalise(&normals[i]);
}

// Does what vertexNormals() does, but treats the two sides of a seam as one vertex.
std::vector<float> normalsAcrossSeams(const Mesh& mesh) {
  std::vector<float> normals = normalSums(mesh);
  joinSeams(mesh, normals);
  normaliseAll(normals);
  return normals;
}

}  // namespace

std::array<float, 3> faceNormal(const float* a, const float* b, const float* c) noexcept {
  // Computed in double, because in float the cross product of a sliver triangle is mostly rounding
  // error.
  const double u[] = {double{b[0]} - a[0], double{b[1]} - a[1], double{b[2]} - a[2]};
  const double v[] = {double{c[0]} - a[0], double{c[1]} - a[1], double{c[2]} - a[2]};
  const double n[] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                      u[0] * v[1] - u[1] * v[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!(length > 0)) return {};
  return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length),
          static_cast<float>(n[2] / length)};
}

bool areOneSurface(const float* normal, const float* other) noexcept {
  return dot(normal, other) > 0;
}

std::vector<float> vertexNormals(const Mesh& mesh) {
  std::vector<float> normals = normalSums(mesh);
  normaliseAll(normals);
  return normals;
}

void ensureNormals(Mesh& mesh) {
  Feature* present = mesh.find("normal");
  if (present && present->dimension == 3 && areUnit(present->values)) return;
  Feature normal{"normal", 3,
                 mesh.find("texcoord") ? normalsAcrossSeams(mesh) : vertexNormals(mesh)};
  if (present)
    *present = std::move(normal);
  else
    mesh.features.push_back(std::move(normal));
}

}  // namespace merlin::render::mesh
