#include "daemon/cli/mesh/edge_bands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

namespace merlin::cli {
namespace {

// Width of a band, as a share of the distance from the edge to the centroid.
constexpr float kBand = 0.25F;
const Eigen::Vector3f kInside{0.1F, 0.1F, 0.12F};  // colour between the bands

// Returns the colour for a position on the scale from red (0) through yellow, green and cyan to
// blue (1).
Eigen::Vector3f rainbow(float share) {
  const float at = 4 * std::clamp(share, 0.0F, 1.0F);
  const auto ramp = [at](float middle) {
    return std::clamp(2 - std::abs(at - middle), 0.0F, 1.0F);
  };
  return {std::clamp(2 - at, 0.0F, 1.0F), ramp(2), std::clamp(at - 2, 0.0F, 1.0F)};
}

using Corners = std::array<Eigen::Vector3f, 3>;

Corners cornersOf(const render::mesh::Mesh& mesh, std::size_t triangle) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = Eigen::Map<const Eigen::Vector3f>(
        &mesh.positions[3 * std::size_t{mesh.triangles[3 * triangle + k]}]);
  return corners;
}

std::vector<float> sorted(std::span<const float> lengths) {
  std::vector<float> all(lengths.begin(), lengths.end());
  std::sort(all.begin(), all.end());
  return all;
}

// Collects polygons, each with its own colour, into a mesh; all vertices have the same normal.
class Polygons {
 public:
  explicit Polygons(const Eigen::Vector3f& normal) : normal_(normal) {}

  void add(std::initializer_list<Eigen::Vector3f> corners, const Eigen::Vector3f& colour) {
    const auto first = static_cast<std::uint32_t>(positions_.size() / 3);
    for (const Eigen::Vector3f& corner : corners) {
      positions_.insert(positions_.end(), corner.begin(), corner.end());
      normals_.insert(normals_.end(), normal_.begin(), normal_.end());
      colours_.insert(colours_.end(), colour.begin(), colour.end());
    }
    for (std::uint32_t k = 2; k < corners.size(); ++k)
      triangles_.insert(triangles_.end(), {first, first + k - 1, first + k});
  }
  render::mesh::Mesh mesh() && {
    return {std::move(positions_),
            {{"normal", 3, std::move(normals_)}, {"colour", 3, std::move(colours_)}},
            std::move(triangles_)};
  }

 private:
  Eigen::Vector3f normal_;
  std::vector<float> positions_, normals_, colours_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace

std::vector<float> lengthsInSpace(const render::mesh::Mesh& mesh) {
  std::vector<float> lengths;
  lengths.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const Corners corners = cornersOf(mesh, t);
    for (std::size_t edge = 0; edge < 3; ++edge)
      lengths.push_back((corners[(edge + 1) % 3] - corners[edge]).norm());
  }
  return lengths;
}

std::vector<float> ranksOf(std::span<const float> lengths) {
  const std::vector<float> all = sorted(lengths);
  std::vector<float> ranks;
  ranks.reserve(lengths.size());
  for (const float length : lengths) {
    const auto [first, last] = std::equal_range(all.begin(), all.end(), length);
    const auto sum = static_cast<float>((first - all.begin()) + (last - all.begin()));
    ranks.push_back(sum / (2 * static_cast<float>(all.size())));
  }
  return ranks;
}

std::vector<float> sizesOf(std::span<const float> lengths) {
  if (lengths.empty()) return {};
  const std::vector<float> all = sorted(lengths);
  float low = all[all.size() / 100], high = all[all.size() - 1 - all.size() / 100];
  if (!(low < high)) low = all.front(), high = all.back();
  std::vector<float> sizes;
  sizes.reserve(lengths.size());
  for (const float length : lengths)
    sizes.push_back(low < high ? std::clamp((length - low) / (high - low), 0.0F, 1.0F) : 0.0F);
  return sizes;
}

render::mesh::Mesh edgeBands(const render::mesh::Mesh& mesh, std::span<const float> places,
                             const View& view) {
  // Direction from the surface to the renderer's light; surfaces with this normal are drawn in
  // their full colour.
  const Eigen::Vector3f light = Eigen::Vector3f(0.15F, 0.35F, 1).normalized();
  Polygons polygons(view.T_eye_model().linear().transpose() * light);
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const Corners outer = cornersOf(mesh, t);
    const Eigen::Vector3f middle = (outer[0] + outer[1] + outer[2]) / 3;
    Corners inner = outer;
    for (Eigen::Vector3f& corner : inner) corner += kBand * (middle - corner);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      polygons.add({outer[i], outer[j], inner[j], inner[i]}, rainbow(places[3 * t + i]));
    }
    polygons.add({inner[0], inner[1], inner[2]}, kInside);
  }
  return std::move(polygons).mesh();
}

render::mesh::Mesh framed(render::mesh::Mesh mesh, const render::mesh::Mesh& other) {
  render::mesh::ensureNormals(mesh);
  const render::mesh::Box box = render::mesh::boundingBox(other.positions);
  for (const auto& corner : {box.low, box.high}) {
    mesh.positions.insert(mesh.positions.end(), corner.begin(), corner.end());
    for (render::mesh::Feature& f : mesh.features)
      f.values.insert(f.values.end(), f.dimension, 0.0F);
  }
  return mesh;
}

View bandView(View view) {
  view.model.style.brightness = 1;
  view.model.style.wireframe = false;
  view.model.show = {};
  return view;
}

}  // namespace merlin::cli
