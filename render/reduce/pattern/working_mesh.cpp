#include "render/reduce/pattern/working_mesh.h"

#include <algorithm>
#include <iterator>

namespace merlin::render::reduce {
namespace {

// Marks removed triangles and edges, as their first vertex.
constexpr std::uint32_t kGone = ~std::uint32_t{0};
// Lists longer than this keep removed entries until tidy().
constexpr std::size_t kLongList = 64;

std::vector<WorkingMesh::Corners> cornersOf(const mesh::Mesh& mesh) {
  std::vector<WorkingMesh::Corners> corners(mesh.triangleCount());
  for (std::size_t t = 0; t < corners.size(); ++t) {
    std::copy_n(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t), 3, corners[t].begin());
  }
  return corners;
}

// Returns each edge once, sorted by its two ends.
std::vector<WorkingMesh::Ends> uniqueEdges(const std::vector<WorkingMesh::Corners>& corners) {
  std::vector<WorkingMesh::Ends> ends;
  ends.reserve(corners.size() * 3);
  for (const auto& c : corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = c[k], b = c[(k + 1) % 3];
      ends.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

template <std::size_t N>
ListPool listsOf(std::size_t vertices, const std::vector<std::array<std::uint32_t, N>>& rows) {
  std::vector<std::uint32_t> counts(vertices, 0);
  for (const auto& row : rows) {
    for (const std::uint32_t v : row) ++counts[v];
  }
  ListPool lists(counts);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const std::uint32_t v : rows[i]) lists.append(v, static_cast<std::uint32_t>(i));
  }
  return lists;
}

}  // namespace

WorkingMesh::WorkingMesh(const mesh::Mesh& mesh)
    : corners_(cornersOf(mesh)),
      ends_(uniqueEdges(corners_)),
      around_(listsOf(mesh.vertexCount(), corners_)),
      spokes_(listsOf(mesh.vertexCount(), ends_)),
      shared_(ends_.size(), 0),
      stale_triangles_(mesh.vertexCount(), 0),
      stale_edges_(mesh.vertexCount(), 0),
      mark_(mesh.vertexCount(), 0),
      count_(mesh.vertexCount(), 0),
      live_(corners_.size()) {
  for (std::uint32_t v = 0; v < mark_.size(); ++v) countTriangles(v);
}

// Recomputes shared_, the number of triangles, of each edge of vertex a.
void WorkingMesh::countTriangles(std::uint32_t a) {
  for (const std::uint32_t e : spokes_[a]) count_[otherEnd(e, a)] = 0;
  for (const std::uint32_t t : around_[a]) {
    for (const std::uint32_t v : corners_[t]) ++count_[v];
  }
  for (const std::uint32_t e : spokes_[a]) shared_[e] = count_[otherEnd(e, a)];
}

void WorkingMesh::tidy(std::uint32_t v) {
  const auto drop = [&](ListPool& lists, std::uint32_t& stale, const auto& is_gone) {
    if (stale == 0) return;
    const auto list = lists[v];
    scratch_.clear();
    std::remove_copy_if(list.begin(), list.end(), std::back_inserter(scratch_), is_gone);
    lists.assign(v, scratch_);
    stale = 0;
  };
  drop(around_, stale_triangles_[v], [&](std::uint32_t t) { return corners_[t][0] == kGone; });
  drop(spokes_, stale_edges_[v], [&](std::uint32_t e) { return ends_[e][0] == kGone; });
}

void WorkingMesh::loseTriangle(std::uint32_t v, std::uint32_t t) {
  if (around_[v].size() > kLongList)
    ++stale_triangles_[v];
  else
    around_.remove(v, t);
}

void WorkingMesh::loseEdge(std::uint32_t v, std::uint32_t e) {
  if (spokes_[v].size() > kLongList)
    ++stale_edges_[v];
  else
    spokes_.remove(v, e);
}

bool WorkingMesh::isBoundary(std::uint32_t v) const noexcept {
  for (const std::uint32_t e : spokes_[v]) {
    if (shared_[e] == 1) return true;
  }
  return false;
}

bool WorkingMesh::linkCondition(std::uint32_t edge) noexcept {
  const auto [a, b] = ends_[edge];
  ++stamp_;
  for (const std::uint32_t e : spokes_[a]) mark_[otherEnd(e, a)] = stamp_;
  std::size_t common = 0;
  for (const std::uint32_t e : spokes_[b]) common += mark_[otherEnd(e, b)] == stamp_;
  const std::size_t shared = shared_[edge];
  if (common != shared) return false;
  if (around_[a].size() + around_[b].size() == 2 * shared) return false;  // no triangle would stay
  if (shared == 2 && linksShareAnEdge(a, b)) return false;
  return shared == 1 || !(isBoundary(a) && isBoundary(b));
}

// Returns true if a face at a and a face at b would coincide after the collapse, as on a
// tetrahedron.
bool WorkingMesh::linksShareAnEdge(std::uint32_t a, std::uint32_t b) const noexcept {
  const auto has = [&](std::uint32_t t, std::uint32_t v) { return v == a || contains(t, v); };
  for (const std::uint32_t t : around_[a]) {
    if (contains(t, b)) continue;
    for (const std::uint32_t u : around_[b]) {
      const Corners& c = corners_[t];
      if (has(u, c[0]) && has(u, c[1]) && has(u, c[2])) return true;
    }
  }
  return false;
}

std::span<const std::uint32_t> WorkingMesh::collapse(std::uint32_t a, std::uint32_t b) {
  gone_.clear();
  mergeTriangles(a, b);
  mergeEdges(a, b);
  return gone_;
}

void WorkingMesh::mergeTriangles(std::uint32_t a, std::uint32_t b) {
  scratch_.clear();
  for (const std::uint32_t t : around_[a]) {
    if (!contains(t, b)) scratch_.push_back(t);
  }
  for (const std::uint32_t t : around_[b]) {
    if (contains(t, a)) {
      --live_;
      for (const std::uint32_t v : corners_[t]) {
        if (v != a && v != b) loseTriangle(v, t);
      }
      corners_[t][0] = kGone;
      continue;
    }
    for (std::uint32_t& v : corners_[t]) {
      if (v == b) v = a;
    }
    scratch_.push_back(t);
  }
  around_.assign(b, {});
  around_.assign(a, scratch_);
}

void WorkingMesh::mergeEdges(std::uint32_t a, std::uint32_t b) {
  ++stamp_;
  scratch_.clear();
  for (const std::uint32_t e : spokes_[a]) {
    const std::uint32_t x = otherEnd(e, a);
    if (x == b) {
      gone_.push_back(e);
      continue;
    }
    mark_[x] = stamp_;
    scratch_.push_back(e);
  }
  for (const std::uint32_t e : spokes_[b]) {
    const std::uint32_t x = otherEnd(e, b);
    if (x == a) continue;
    if (mark_[x] == stamp_) {  // a and b both had an edge to x: one remains
      gone_.push_back(e);
      loseEdge(x, e);
      continue;
    }
    ends_[e] = {a, x};
    scratch_.push_back(e);
  }
  spokes_.assign(b, {});
  spokes_.assign(a, scratch_);
  countTriangles(a);
  // An edge whose only triangle was removed is removed as well.
  std::erase_if(scratch_, [&](std::uint32_t e) {
    if (shared_[e] > 0) return false;
    gone_.push_back(e);
    loseEdge(otherEnd(e, a), e);
    return true;
  });
  spokes_.assign(a, scratch_);
  for (const std::uint32_t e : gone_) ends_[e][0] = kGone;
}

}  // namespace merlin::render::reduce
