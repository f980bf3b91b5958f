#include "render/mesh/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>

namespace merlin::render::mesh {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMost = std::size_t{1} << 31;
constexpr float kMaxCoordinate = 1e18F;  // largest coordinate: squared distances are finite floats

bool repeats(const std::uint32_t* t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

std::size_t dropDegenerate(Mesh& mesh) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    if (repeats(&mesh.triangles[i])) continue;
    std::copy_n(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i), 3,
                mesh.triangles.begin() + static_cast<std::ptrdiff_t>(kept));
    kept += 3;
  }
  const std::size_t dropped = (mesh.triangles.size() - kept) / 3;
  mesh.triangles.resize(kept);
  return dropped;
}

// Returns the corners of the triangle, rotated so that the smallest index is first; the orientation
// stays.
std::array<std::uint32_t, 3> turned(const std::uint32_t* t) {
  const auto k = static_cast<std::size_t>(std::min_element(t, t + 3) - t);
  return {t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
}

// Makes duplicate triangles degenerate, so that they will be dropped. `same`: triangles with the
// same smallest vertex.
void markDuplicates(Mesh& mesh, std::span<std::uint32_t> same, TidyReport& report) {
  const auto key = [&](std::uint32_t t) {
    const auto [a, b, c] = turned(&mesh.triangles[3 * std::size_t{t}]);
    return std::tuple(std::min(b, c), std::max(b, c), t);
  };
  std::sort(same.begin(), same.end(),
            [&](std::uint32_t s, std::uint32_t t) { return key(s) < key(t); });
  std::size_t kept = 0;
  for (std::size_t i = 1; i < same.size(); ++i) {
    const auto first = turned(&mesh.triangles[3 * std::size_t{same[kept]}]);
    std::uint32_t* t = &mesh.triangles[3 * std::size_t{same[i]}];
    const auto other = turned(t);
    const bool equal = first == other, opposite = first[1] == other[2] && first[2] == other[1];
    if (!equal && !opposite) {
      kept = i;
      continue;
    }
    ++(equal ? report.duplicate : report.opposite);
    t[1] = t[2] = t[0];
  }
}

void dropDuplicates(Mesh& mesh, TidyReport& report) {
  const auto triangles = static_cast<std::uint32_t>(mesh.triangleCount());
  const auto smallest = [&](std::uint32_t t) {
    const std::uint32_t* v = &mesh.triangles[3 * std::size_t{t}];
    return std::min({v[0], v[1], v[2]});
  };
  std::vector<std::uint32_t> end(mesh.vertexCount() + 1, 0), list(triangles);
  for (std::uint32_t t = 0; t < triangles; ++t) ++end[smallest(t) + 1];
  for (std::size_t v = 0; v + 1 < end.size(); ++v) end[v + 1] += end[v];
  for (std::uint32_t t = 0; t < triangles; ++t) list[end[smallest(t)]++] = t;
  std::uint32_t first = 0;
  for (const std::uint32_t last : end) {
    if (last - first > 1) markDuplicates(mesh, {list.data() + first, last - first}, report);
    first = last;
  }
  if (report.duplicate + report.opposite > 0) dropDegenerate(mesh);
}

// Moves each row of `values` to index `place[row]`, which is never above its old index; rows whose
// place is kUnused are dropped.
void compactRows(std::vector<float>& values, std::size_t dimension,
                 const std::vector<std::uint32_t>& place, std::size_t rows) {
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] == kUnused) continue;
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(v * dimension), dimension,
                values.begin() + static_cast<std::ptrdiff_t>(place[v] * dimension));
  }
  values.resize(rows * dimension);
}

std::size_t dropUnused(Mesh& mesh) {
  std::vector<bool> used(mesh.vertexCount(), false);
  for (const std::uint32_t v : mesh.triangles) used[v] = true;
  return keepVertices(mesh, used);
}

Result<Ok> validate(const Feature& f, std::size_t vertices) {
  if (f.values.size() != vertices * f.dimension) {
    return Error{Errc::kMalformed, fmt::format("feature {}: {} values for {} vertices x {}", f.name,
                                               f.values.size(), vertices, f.dimension)};
  }
  for (std::size_t i = 0; i < f.values.size(); ++i) {
    if (std::isfinite(f.values[i])) continue;
    return Error{Errc::kMalformed,
                 fmt::format("feature {}: vertex {} has {}", f.name, i / f.dimension, f.values[i])};
  }
  return Ok{};
}

}  // namespace

float Box::diagonal() const noexcept {
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

const Feature* Mesh::find(std::string_view name) const noexcept {
  for (const Feature& f : features) {
    if (f.name == name) return &f;
  }
  return nullptr;
}

Feature* Mesh::find(std::string_view name) noexcept {
  return const_cast<Feature*>(std::as_const(*this).find(name));
}

Result<Ok> validate(const Mesh& mesh) {
  const std::size_t n = mesh.vertexCount();
  if (n >= kMost || mesh.triangleCount() >= kMost) {
    return Error{Errc::kUnsupported,
                 fmt::format("{} vertices and {} triangles; each must be below 2^31", n,
                             mesh.triangleCount())};
  }
  if (mesh.positions.size() % 3 != 0 || mesh.triangles.size() % 3 != 0) {
    return Error{Errc::kMalformed, fmt::format("{} coordinates, {} corners: not multiples of 3",
                                               mesh.positions.size(), mesh.triangles.size())};
  }
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (std::abs(mesh.positions[i]) <= kMaxCoordinate) continue;
    return Error{Errc::kMalformed,
                 fmt::format("vertex {}: coordinate {} is {}; the limit is +-{}", i / 3,
                             "xyz"[i % 3], mesh.positions[i], kMaxCoordinate)};
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (mesh.triangles[i] < n) continue;
    return Error{Errc::kMalformed,
                 fmt::format("triangle {}: there is no vertex {}, the mesh has {} (0 to {})", i / 3,
                             mesh.triangles[i], n, n == 0 ? 0 : n - 1)};
  }
  for (const Feature& f : mesh.features) {
    if (const auto valid = validate(f, n); !valid) return valid;
  }
  return Ok{};
}

std::size_t keepVertices(Mesh& mesh, const std::vector<bool>& kept) {
  std::vector<std::uint32_t> place(mesh.vertexCount(), kUnused);
  std::uint32_t rows = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (kept[v]) place[v] = rows++;
  }
  const std::size_t dropped = mesh.vertexCount() - rows;
  if (dropped == 0) return 0;
  for (std::uint32_t& v : mesh.triangles) v = place[v];
  compactRows(mesh.positions, 3, place, rows);
  for (Feature& f : mesh.features) compactRows(f.values, f.dimension, place, rows);
  return dropped;
}

std::uint32_t addCopy(std::uint32_t vertex, Mesh& mesh) {
  const auto copy = [vertex](std::vector<float>& values, std::size_t dimension) {
    for (std::size_t k = 0; k < dimension; ++k) values.push_back(values[vertex * dimension + k]);
  };
  copy(mesh.positions, 3);
  for (Feature& f : mesh.features) copy(f.values, f.dimension);
  return static_cast<std::uint32_t>(mesh.vertexCount() - 1);
}

TidyReport tidy(Mesh& mesh) {
  TidyReport report;
  report.degenerate = dropDegenerate(mesh);
  dropDuplicates(mesh, report);
  report.unused = dropUnused(mesh);
  return report;
}

Box boundingBox(std::span<const float> positions) noexcept {
  if (positions.size() < 3) return {};
  Box box{{positions[0], positions[1], positions[2]}, {positions[0], positions[1], positions[2]}};
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], positions[i + k]);
      box.high[k] = std::max(box.high[k], positions[i + k]);
    }
  }
  return box;
}

}  // namespace merlin::render::mesh
