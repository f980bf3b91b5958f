#include "render/lod/view_cut.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace merlin::render::lod {
namespace {

constexpr double kStepsAnOctave = 64;
// All clusters get the same level if the finest wanted detail is at most this multiple of the
// coarsest, since different levels would then gain nothing.
constexpr float kMuchTheSame = 1.15F;
// Lower limit of the cosine g, because the silhouette of a surface that is seen edge-on is still
// visible.
constexpr float kLeastFacing = 0.1F;
constexpr int kBisections = 12;
constexpr float kLeastOfNeighbour = 0.4F;
constexpr int kGradings = 3;
// Clusters get levels of their own only for budgets above this multiple of the coarsest level's
// triangles: with a smaller budget, a cluster has only a few triangles, most of them at its border.
constexpr std::size_t kTimesTheCoarsest = 4;

// Frustum planes, eye and scale of the view of one tile.
struct Viewer {
  bool parallel;                      // the eye is infinitely far away
  Eigen::Matrix<float, 5, 4> planes;  // left, right, bottom, top, near; unit normals point inwards
  Eigen::Vector4f depth;              // the row of the matrix that computes w
  // Position [model units]; in a parallel projection, view direction.
  Eigen::Vector3f eye;
  float near_w, pixels_per_unit;  // w at the near plane; pixels per model unit at w = 1
  float depth_per_unit;

  explicit Viewer(const TileView& tile) {
    const Eigen::Matrix4f& m = tile.clip_from_model;
    depth = m.row(3).transpose();
    for (int k = 0; k < 5; ++k) {
      const float sign = k % 2 == 0 ? 1.0F : -1.0F;
      planes.row(k) = m.row(3) + sign * m.row(k / 2);
      planes.row(k) /= std::max(planes.row(k).head<3>().norm(), 1e-30F);
    }
    pixels_per_unit =
        tile.weight * static_cast<float>(tile.width_px) / 2 * m.row(0).head<3>().norm();
    parallel = depth.head<3>().isZero(0);
    if (parallel) {
      eye = m.row(2).head<3>().normalized();
      near_w = depth_per_unit = 0;
      return;
    }
    Eigen::Matrix3f axes;
    axes << m.row(0).head<3>(), m.row(1).head<3>(), m.row(3).head<3>();
    eye = axes.inverse() * -Eigen::Vector3f(m(0, 3), m(1, 3), m(3, 3));
    depth_per_unit = depth.head<3>().norm();
    // Clip coordinates satisfy z = a w + b, and z = -w at the near plane.
    const float a = m.row(2).head<3>().dot(m.row(3).head<3>()) / (depth_per_unit * depth_per_unit);
    near_w = std::max((a * m(3, 3) - m(2, 3)) / (1 + a), 1e-6F);
  }

  bool sees(const Eigen::Vector3f& centre, float radius) const {
    return ((planes * centre.homogeneous()).array() >= -radius).all();
  }

  // Returns an upper limit of the cosine at which a triangle of the cluster is seen; 0 if all of
  // its triangles face away.
  float facing(const ClusterBounds& b, const Eigen::Vector3f& centre) const {
    if (b.cone_cos <= 0) return 1;
    const Eigen::Vector3f to = parallel ? eye : Eigen::Vector3f(centre - eye);
    const float distance = to.norm();
    if (!parallel && distance <= b.radius) return 1;
    const float towards = -to.dot(Eigen::Vector3f(b.axis.data())) / distance;
    const float spread = parallel ? 0 : std::asin(b.radius / distance);
    const float angle =
        std::acos(std::clamp(towards, -1.0F, 1.0F)) - std::acos(b.cone_cos) - spread;
    if (angle <= 0) return 1;
    return angle >= static_cast<float>(M_PI_2) ? 0 : std::max(std::cos(angle), kLeastFacing);
  }

  // Returns the pixels per model unit at the point half a radius in front of the cluster's centre,
  // but no nearer to the eye than a quarter of the radius. In a parallel projection the value is
  // the same everywhere.
  float pixelsAUnit(const Eigen::Vector3f& centre, float radius) const {
    const float r = radius * depth_per_unit;
    const float w = std::max(depth.dot(centre.homogeneous()) - r / 2, r / 4);
    return pixels_per_unit / std::max(w, near_w);
  }
};

}  // namespace

ViewCut::ViewCut(const Dendrogram& dendrogram, const Clusters& clusters, bool back_faces)
    : dendrogram_(dendrogram),
      clusters_(clusters),
      back_faces_(back_faces),
      wanted_(clusters.size()),
      levels_(clusters.size(), static_cast<std::uint32_t>(clusters.coarsestLevel())) {
  const double octaves = std::log2(static_cast<double>(dendrogram.triangleCount()) + 1) + 1;
  for (double step = 0; step <= octaves * kStepsAnOctave; ++step) {
    const std::size_t level =
        dendrogram.levelFor(static_cast<std::size_t>(std::exp2(step / kStepsAnOctave)));
    level_table_.push_back(static_cast<std::uint32_t>(
        std::clamp(level, clusters.finestLevel(), clusters.coarsestLevel())));
  }
}

void ViewCut::look(std::span<const TileView> tiles) {
  seen_.assign(tiles.size() * clusters_.size(), 0);
  std::fill(wanted_.begin(), wanted_.end(), 0.0F);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const Viewer viewer(tiles[t]);
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      const ClusterBounds& b = clusters_.bounds(c);
      const Eigen::Vector3f centre(b.centre.data());
      if (!viewer.sees(centre, b.radius)) continue;
      seen_[t * clusters_.size() + c] = 1;
      const float facing = back_faces_ ? 1 : viewer.facing(b, centre);
      const float p = viewer.pixelsAUnit(centre, b.radius);
      wanted_[c] = std::max(wanted_[c], p * std::sqrt(facing));
    }
  }
}

// Raises wanted_ of the neighbours of visible clusters, so that it differs little between
// neighbours. Makes few passes, so that clusters far from everything visible stay as coarse as
// possible.
void ViewCut::grade() {
  for (int pass = 0; pass < kGradings; ++pass) {
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      for (const std::uint16_t n : clusters_.neighbours(c)) {
        wanted_[c] = std::max(wanted_[c], kLeastOfNeighbour * wanted_[n]);
        wanted_[n] = std::max(wanted_[n], kLeastOfNeighbour * wanted_[c]);
      }
    }
  }
}

std::size_t ViewCut::levelOf(double triangles) const noexcept {
  const double step = std::log2(std::max(triangles, 1.0)) * kStepsAnOctave;
  return level_table_[std::min(static_cast<std::size_t>(step), level_table_.size() - 1)];
}

std::size_t ViewCut::spend(double kappa) {
  std::size_t triangles = clusters_.alwaysThere();
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    const std::size_t level =
        wanted_[c] > 0 ? levelOf(kappa * wanted_[c]) : clusters_.coarsestLevel();
    levels_[c] = static_cast<std::uint32_t>(level);
    triangles += clusters_.trianglesAt(c, level);
  }
  return triangles;
}

bool ViewCut::choose(std::span<const TileView> tiles, std::size_t budget) {
  look(tiles);
  if (budget <= kTimesTheCoarsest * dendrogram_.trianglesAt(clusters_.coarsestLevel()))
    return false;
  const auto [least, most] = std::minmax_element(wanted_.begin(), wanted_.end());
  if (*most <= 0 || *most <= kMuchTheSame * *least) return false;
  grade();
  // The largest useful kappa gives all visible clusters full detail; it is used if the budget
  // allows it.
  double high = 2 * static_cast<double>(dendrogram_.triangleCount()) / *most;
  for (const float w : wanted_) {
    if (w > 0) high = std::max(high, 2 * static_cast<double>(dendrogram_.triangleCount()) / w);
  }
  if (spend(high) <= budget) return true;
  double low = 1 / static_cast<double>(*most);
  for (int i = 0; i < kBisections; ++i) {
    const double middle = std::sqrt(low * high);
    (spend(middle) <= budget ? low : high) = middle;
  }
  spend(low);
  return true;
}

}  // namespace merlin::render::lod
