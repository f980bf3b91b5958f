#include "render/fuse/blend.h"

#include <algorithm>
#include <cmath>

#include "daemon/base/blocks.h"

namespace merlin::render::fuse {
namespace {

constexpr int kMostSteps = 256;  // limit of spreading steps; vertices not reached keep 0

// The contribution of one scan to a vertex.
struct Share {
  const View* view;
  Sight sight;
  double weight;
};

Point vertexAt(const mesh::Mesh& mesh, std::size_t vertex) {
  const float* p = &mesh.positions[3 * vertex];
  return {double{p[0]}, double{p[1]}, double{p[2]}};
}

std::vector<Share> sharesOf(std::span<const View> views, double truncation, const Point& at) {
  std::vector<Share> shares;
  for (const View& view : views) {
    const Sight sight = view.at(at);
    if (sight.kind != Sight::Kind::kNear) continue;
    // Makes the weight fall to 0 in front of a surface, as View::at() does behind it.
    const double front = sight.distance > 0 ? 1 - sight.distance / truncation : 1;
    shares.push_back({&view, sight, sight.weight * front});
  }
  return shares;
}

// Returns component `k` of the plane at the point where the ray meets the surface; `whole`: the
// value of the nearest pixel instead of an interpolated one.
double valueAt(const range::Plane& plane, const Sight& sight, std::size_t k, bool whole) {
  const auto at = [&](std::size_t i) {
    return double{plane.values[sight.pixels[i] * plane.dimension + k]};
  };
  if (whole) {
    const auto& s = sight.shares;
    return at(static_cast<std::size_t>(std::max_element(s.begin(), s.end()) - s.begin()));
  }
  return sight.shares[0] * at(0) + sight.shares[1] * at(1) + sight.shares[2] * at(2);
}

// Computes the values of a feature at a vertex and stores them in `out`; returns whether any scan
// has a value there.
bool setValues(const std::vector<Share>& shares, const Blended& blended, float* out) {
  double weights = 0, best = 0;
  std::array<double, 16> sums{};
  for (const Share& share : shares) {
    const range::Plane* plane = share.view->image().find(blended.name);
    if (!plane || plane->dimension != blended.dimension || !(share.weight > 0)) continue;
    std::array<double, 16> values{};
    bool finite = true;
    for (std::size_t k = 0; k < blended.dimension; ++k) {
      values[k] = valueAt(*plane, share.sight, k, blended.whole);
      finite = finite && std::isfinite(values[k]);
    }
    if (!finite || (blended.whole && share.weight <= best)) continue;
    best = share.weight;
    if (blended.whole) sums = {}, weights = 0;
    weights += share.weight;
    for (std::size_t k = 0; k < blended.dimension; ++k) sums[k] += share.weight * values[k];
  }
  if (!(weights > 0)) return false;
  for (std::size_t k = 0; k < blended.dimension; ++k)
    out[k] = static_cast<float>(sums[k] / weights);
  return true;
}

// Does one step of spreading: a vertex without a value gets the mean of its neighbours' values (for
// labels, the value of the first neighbour) if any of them has a value. Returns the number of
// vertices that got a value.
std::size_t spreadOnce(const mesh::Mesh& mesh, bool whole, mesh::Feature& feature,
                       std::vector<std::uint8_t>& has) {
  const std::size_t n = feature.dimension;
  std::vector<std::uint32_t> counts(has.size(), 0);
  const auto add = [&](std::size_t to, std::size_t from) {
    if (has[to] || !has[from] || (whole && counts[to] > 0)) return;
    ++counts[to];
    for (std::size_t k = 0; k < n; ++k) feature.values[to * n + k] += feature.values[from * n + k];
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t next = t % 3 == 2 ? t - 2 : t + 1;
    add(mesh.triangles[t], mesh.triangles[next]);
    add(mesh.triangles[next], mesh.triangles[t]);
  }
  std::size_t filled = 0;
  for (std::size_t v = 0; v < has.size(); ++v) {
    if (counts[v] == 0) continue;
    has[v] = 1;
    ++filled;
    for (std::size_t k = 0; k < n; ++k) feature.values[v * n + k] /= static_cast<float>(counts[v]);
  }
  return filled;
}

}  // namespace

std::vector<Blended> blendedOf(std::span<const View> views) {
  std::vector<Blended> all;
  for (const View& view : views) {
    for (const range::Plane& plane : view.image().planes) {
      const bool known = std::any_of(all.begin(), all.end(),
                                     [&](const Blended& b) { return b.name == plane.name; });
      if (known || plane.dimension == 0 || plane.dimension > 16) continue;
      all.push_back({plane.name, plane.dimension, plane.name == "label" || plane.name == "part"});
    }
  }
  return all;
}

Blending blend(std::span<const View> views, double truncation, unsigned threads, mesh::Mesh& mesh) {
  const std::vector<Blended> planes = blendedOf(views);
  const std::size_t vertices = mesh.vertexCount();
  Blending blending;
  blending.measured.assign(vertices, 0);
  std::vector<std::vector<std::uint8_t>> has(planes.size(), std::vector<std::uint8_t>(vertices, 0));
  const std::size_t first = mesh.features.size();
  for (const Blended& plane : planes)
    mesh.features.push_back(
        {plane.name, plane.dimension, std::vector<float>(vertices * plane.dimension, 0)});
  forEach(threads, vertices, [&](std::size_t v) {
    const std::vector<Share> shares = sharesOf(views, truncation, vertexAt(mesh, v));
    blending.measured[v] = std::any_of(shares.begin(), shares.end(), [&](const Share& share) {
      return std::abs(share.sight.distance) <= truncation / 2;
    });
    for (std::size_t i = 0; i < planes.size(); ++i)
      has[i][v] =
          setValues(shares, planes[i], &mesh.features[first + i].values[v * planes[i].dimension]);
  });
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const auto lacks = [&] {
      return static_cast<std::size_t>(std::count(has[i].begin(), has[i].end(), 0));
    };
    mesh::Feature& feature = mesh.features[first + i];
    int step = 0;
    while (step++ < kMostSteps && lacks() > 0 &&
           spreadOnce(mesh, planes[i].whole, feature, has[i]) > 0) {
    }
    blending.without = std::max(blending.without, lacks());
  }
  return blending;
}

}  // namespace merlin::render::fuse
