#include "render/reduce/quadric/quadric_mesh.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "daemon/base/blocks.h"
#include "render/mesh/morton.h"

namespace merlin::render::reduce {
namespace {

std::uint32_t linesFor(std::uint32_t corners) {
  return std::max(1U, (corners + kLine - 1) / kLine);
}

constexpr std::uint32_t kClaim = 1 << 13;  // number of corners claimed at a time
constexpr unsigned kMostScans = 8;         // threads that each scan all triangles in fillStars()

// Calls work(v) for each of n vertices, in parallel; work(v) may write only data of v.
template <typename Work>
void forEachVertex(std::size_t n, Threads threads, const Work& work) {
  forEach(threads, n, [&](std::size_t v) { work(static_cast<std::uint32_t>(v)); });
}

// Sorts the keys by their upper 3 x `bits` bits; stable.
void radixSort(HugeArray<std::uint64_t>& keys, unsigned bits) {
  HugeArray<std::uint64_t> other(keys.size());
  const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  for (unsigned shift = 64 - 3 * bits; shift < 64; shift += bits) {
    std::vector<std::size_t> at(mask + 2);
    for (std::size_t i = 0; i < keys.size(); ++i) ++at[(keys[i] >> shift & mask) + 1];
    for (std::size_t i = 1; i < at.size(); ++i) at[i] += at[i - 1];
    for (std::size_t i = 0; i < keys.size(); ++i) other[at[keys[i] >> shift & mask]++] = keys[i];
    std::swap(keys, other);
  }
}

// Returns 1 / mean edge length, estimated from a sample of the edges.
float scaleOf(const mesh::Mesh& mesh) {
  const std::size_t step = std::max<std::size_t>(1, mesh.triangleCount() / 4096);
  double sum = 0, count = 0;
  for (std::size_t t = 0; t < mesh.triangleCount(); t += step) {
    const float* a = &mesh.positions[3 * std::size_t{mesh.triangles[3 * t]}];
    const float* b = &mesh.positions[3 * std::size_t{mesh.triangles[3 * t + 1]}];
    sum += std::hypot(double{a[0]} - b[0], double{a[1]} - b[1], double{a[2]} - b[2]);
    ++count;
  }
  const double scale = count / sum;
  // If the edges are too short for floats or have no length, the bounding box gives the scale.
  if (sum > 0 && scale < 1e30) return static_cast<float>(scale);
  const float diagonal = mesh::boundingBox(mesh.positions).diagonal();
  return diagonal > 0 ? 1 / diagonal : 1;
}

// Returns true if some vertex is the first one (b) of two corners, which means that the star is
// non-manifold.
bool comesTwice(std::span<const Corner> star) {
  // Fast test: if all b hash to different bits of 64, none occurs twice. Otherwise all pairs are
  // compared.
  std::uint64_t seen = 0;
  bool twice = false;
  for (const Corner& c : star) {
    const unsigned bit = c.b * 0x9E3779B1U >> 26;
    twice |= (seen >> bit & 1) != 0;
    seen |= std::uint64_t{1} << bit;
  }
  if (!twice) return false;
  for (std::size_t i = 0; i < star.size(); ++i) {
    for (std::size_t j = i + 1; j < star.size(); ++j) {
      if (star[i].b == star[j].b) return true;
    }
  }
  return false;
}

}  // namespace

std::optional<std::uint32_t> FreshLines::claim(std::uint32_t corners) {
  std::uint32_t begin = next_;
  do {
    if (end_ - begin < corners) return std::nullopt;
  } while (!next_.compare_exchange_weak(begin, begin + corners));
  return begin;
}

// Makes sure that `corners` unused corners are available; returns false if there are too few.
// Claims 64 KiB at a time, so that threads seldom contend, or only `corners` if that is more or if
// 64 KiB are not available.
bool StarRoom::claimFresh(std::uint32_t corners) {
  if (end_ - next_ >= corners) return true;
  std::uint32_t size = std::max(kClaim, corners);
  std::optional<std::uint32_t> claimed = fresh_->claim(size);
  if (!claimed) claimed = fresh_->claim(size = corners);
  if (!claimed) return false;
  next_ = *claimed;
  end_ = next_ + size;
  return true;
}

std::uint32_t StarRoom::take(std::uint32_t corners, std::uint32_t& capacity) {
  const std::uint32_t lines = linesFor(corners);
  const bool exact = lines < free_.size() && !free_[lines].empty();
  if (!exact && claimFresh(lines * kLine)) {
    capacity = lines * kLine;
    next_ += capacity;
    return next_ - capacity;
  }
  // Reuses returned room: room of the right size, or larger room if no fresh lines are left.
  for (std::size_t k = lines; k < free_.size(); ++k) {
    if (free_[k].empty()) continue;
    const std::uint32_t star = free_[k].back();
    free_[k].pop_back();
    capacity = static_cast<std::uint32_t>(k) * kLine;
    return star;
  }
  throw std::bad_alloc();
}

void StarRoom::give(std::uint32_t star, std::uint32_t capacity) {
  const std::size_t lines = capacity / kLine;
  if (free_.size() <= lines) free_.resize(lines + 1);
  free_[lines].push_back(star);
}

void StarRoom::join(StarRoom&& other) {
  if (free_.size() < other.free_.size()) free_.resize(other.free_.size());
  for (std::size_t k = 0; k < other.free_.size(); ++k)
    free_[k].insert(free_[k].end(), other.free_[k].begin(), other.free_[k].end());
  other.free_.clear();
}

// Uses a Morton curve with 1,024 cells per axis. For meshes of more than 4 million vertices, where
// too many would share a cell, uses 4,096 cells per axis if the vertex number still fits into the
// key.
std::vector<std::uint32_t> alongCurve(const mesh::Mesh& mesh, Threads threads) {
  const mesh::Box box = mesh::boundingBox(mesh.positions);
  float extent = 0;
  for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, box.high[k] - box.low[k]);
  if (!(extent > 0)) extent = 1;
  const std::size_t n = mesh.vertexCount();
  const unsigned bits = n < 1U << 22 || n >= 1U << 28 ? 10 : 12;
  HugeArray<std::uint64_t> keys(n);
  forEachVertex(n, threads, [&](std::uint32_t v) {
    const float* point = &mesh.positions[3 * std::size_t{v}];
    const std::uint64_t key = mesh::mortonKey(point, box.low, {extent, extent, extent}, bits);
    keys[v] = key << (64 - 3 * bits) | v;
  });
  radixSort(keys, bits);
  const std::uint64_t low = (std::uint64_t{1} << (64 - 3 * bits)) - 1;
  std::vector<std::uint32_t> curve(n);
  for (std::size_t i = 0; i < n; ++i) curve[i] = static_cast<std::uint32_t>(keys[i] & low);
  return curve;
}

QuadricMesh::QuadricMesh(const mesh::Mesh& mesh, Threads threads)
    : input_(alongCurve(mesh, threads)), scale_(scaleOf(mesh)) {
  const mesh::Box box = mesh::boundingBox(mesh.positions);
  for (std::size_t k = 0; k < 3; ++k) centre_[k] = (box.low[k] + box.high[k]) / 2;
  const std::size_t n = input_.size();
  HugeArray<std::uint32_t> numbers(n);
  vertices_ = HugeArray<QuadricVertex>(n);
  forEachVertex(n, threads, [&](std::uint32_t v) {
    numbers[input_[v]] = v;
    const auto place = toWorking(&mesh.positions[3 * std::size_t{input_[v]}]);
    std::copy(place.begin(), place.end(), vertices_[v].position);
    vertices_[v].node = v;
  });
  fillStars(mesh, numbers, threads);
  forEachVertex(n, threads, [&](std::uint32_t v) { orderStar(vertices_[v]); });
}

std::array<float, 3> QuadricMesh::toWorking(const float* model) const noexcept {
  return {(model[0] - centre_[0]) * scale_, (model[1] - centre_[1]) * scale_,
          (model[2] - centre_[2]) * scale_};
}

std::array<float, 3> QuadricMesh::toModel(const float* position) const noexcept {
  return {position[0] / scale_ + centre_[0], position[1] / scale_ + centre_[1],
          position[2] / scale_ + centre_[2]};
}

// Each thread scans all triangles and stores the corners of its range of vertices.
void QuadricMesh::fillStars(const mesh::Mesh& mesh, const HugeArray<std::uint32_t>& numbers,
                            Threads threads) {
  const auto forEachCorner = [&](const auto& work) {
    const std::size_t ranges = std::min(threads.count, kMostScans);
    forBlocks(threads, ranges, [&](std::size_t range) {
      const auto first = static_cast<std::uint32_t>(vertexCount() * range / ranges);
      const auto last = static_cast<std::uint32_t>(vertexCount() * (range + 1) / ranges);
      for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
        const std::uint32_t v[] = {numbers[mesh.triangles[t]], numbers[mesh.triangles[t + 1]],
                                   numbers[mesh.triangles[t + 2]]};
        for (std::size_t k = 0; k < 3; ++k) {
          if (v[k] >= first && v[k] < last) work(v[k], v[(k + 1) % 3], v[(k + 2) % 3]);
        }
      }
    });
  };
  // places[v] is first the number of corners of v, then the index of its next corner. It is kept
  // apart from the records, so that it stays in the caches.
  HugeArray<std::uint32_t> places(vertexCount());
  forEachCorner([&](std::uint32_t v, std::uint32_t, std::uint32_t) { ++places[v]; });
  std::uint64_t total = 0;
  for (std::uint32_t v = 0; v < vertexCount(); ++v) {
    QuadricVertex& x = vertices_[v];
    x.degree = places[v];
    x.star = places[v] = static_cast<std::uint32_t>(total);
    x.capacity = linesFor(x.degree) * kLine;
    total += x.capacity;
  }
  // Reserves much more than needed now, since growing stars need larger room than other stars
  // return. Pages that are never touched use no memory.
  const std::uint64_t room = std::min<std::uint64_t>(5 * total + (1U << 16), 0xFFFFFFF0U);
  if (total >= room) throw std::bad_alloc();
  stars_ = HugeArray<Corner>(room);
  fresh_.reset(static_cast<std::uint32_t>(total), static_cast<std::uint32_t>(room));
  forEachCorner([&](std::uint32_t v, std::uint32_t b, std::uint32_t c) {
    stars_[places[v]++] = {b, c};
  });
}

void QuadricMesh::tidyHub(std::uint32_t hub) noexcept {
  const auto living = [&](std::uint32_t v) {
    std::uint32_t end = v;
    while (vertices_[end].flags & kDead) end = mergedInto(vertices_[end]);
    while (vertices_[v].flags & kDead) v = std::exchange(mergedInto(vertices_[v]), end);
    return end;
  };
  Corner* const star = corners(vertices_[hub].star);
  Corner* to = star;
  for (const Corner* from = star; from < star + vertices_[hub].degree; ++from) {
    const std::uint32_t b = living(from->b), c = living(from->c);
    *to = {b, c};
    to += b != c;
  }
  vertices_[hub].degree = static_cast<std::uint32_t>(to - star);
}

// Sorts the corners of v into the order of a closed fan; sets kOpen if they do not form one closed
// fan.
void QuadricMesh::orderStar(QuadricVertex& v) {
  Corner* s = stars_.data() + v.star;
  const std::uint32_t n = v.degree;
  bool closed = n > 2 && n <= 1000;  // limit, since this search is O(n^2)
  for (std::uint32_t i = 0; closed && i + 1 < n; ++i) {
    std::uint32_t j = i + 1;
    while (j < n && s[j].b != s[i].c) ++j;
    if (j < n)
      std::swap(s[i + 1], s[j]);
    else
      closed = false;
  }
  closed = closed && s[n - 1].c == s[0].b;
  if (!closed || comesTwice({s, n})) v.flags |= kOpen;
}

}  // namespace merlin::render::reduce
