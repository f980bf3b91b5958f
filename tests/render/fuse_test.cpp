// Fusion of synthetic scans of known shapes: the result is closed, near the shape and blended, and
// does not bridge gaps.
#include "render/fuse/fuse.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "render/range/geometry.h"
#include "render/scan/placement.h"
#include "render/scan/scan.h"
#include "tests/support/meshes.h"

namespace merlin::test {
namespace {

namespace fuse = render::fuse;
namespace range = render::range;
namespace scan = render::scan;
using range::Scanner;

constexpr double kDeg = std::numbers::pi / 180;
constexpr std::size_t kPlenty = std::size_t{1} << 30;

// Returns a scan of 80 x 80 pixels, 30 x 30 degrees, from `from` towards the origin.
range::RangeImage scanFrom(const Mesh& mesh, Scanner scanner, const scan::Point& from) {
  scan::ScanSettings settings;
  settings.width = settings.height = 80;
  range::Geometry& g = settings.geometry;
  g.scanner = scanner;
  g.horizontal_rad = g.vertical_rad = 30 * kDeg;
  g.T_world_scanner = scan::lookAt(from, {0, 0, 0});
  if (scanner == Scanner::kSpinning) {
    g.beams = range::evenBeams(g.vertical_rad, settings.height);
    g.vertical_rad = 0;
  }
  auto taken = scan::scan({mesh}, settings, {1});
  EXPECT_TRUE(taken.ok()) << (taken.ok() ? "" : taken.error().what);
  return taken.ok() ? std::move(taken->image) : range::RangeImage{};
}

// Returns six scans along the axes, from 5 units away from the origin.
std::vector<range::RangeImage> sixScans(const Mesh& mesh, Scanner scanner) {
  std::vector<range::RangeImage> scans;
  for (std::size_t i = 0; i < 6; ++i) {
    scan::Point from{};
    from[i / 2] = i % 2 ? -5 : 5;
    scans.push_back(scanFrom(mesh, scanner, from));
  }
  return scans;
}

fuse::Fused fused(const std::vector<range::RangeImage>& scans, fuse::FuseSettings settings,
                  unsigned threads = 1) {
  if (settings.memory == 0) settings.memory = kPlenty;
  auto result = fuse::fuse(scans, settings, {threads});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().what);
  return result.ok() ? *std::move(result) : fuse::Fused{};
}

fuse::FuseSettings closed(double voxel) {
  fuse::FuseSettings settings;
  settings.voxel = voxel;
  settings.close = true;
  return settings;
}

// Returns the number of edges that do not have one triangle on each side, in opposite directions.
std::size_t openEdges(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t next = t % 3 == 2 ? t - 2 : t + 1;
    ++uses[{mesh.triangles[t], mesh.triangles[next]}];
  }
  std::size_t open = 0;
  for (const auto& [edge, count] : uses) {
    const auto back = uses.find({edge.second, edge.first});
    open += count != 1 || back == uses.end() || back->second != 1;
  }
  return open;
}

// Returns vertices - edges + triangles of a closed mesh; this is 2 for one sphere.
long eulerOf(const Mesh& mesh) {
  return static_cast<long>(mesh.vertexCount()) - static_cast<long>(mesh.triangleCount() / 2);
}

double radiusAt(const Mesh& mesh, std::size_t v) {
  const float* p = &mesh.positions[3 * v];
  return std::hypot(double{p[0]}, double{p[1]}, double{p[2]});
}

class FusedSphere : public testing::TestWithParam<Scanner> {};

TEST_P(FusedSphere, OfSixScansIsClosedAndWithinAFifthOfAVoxel) {
  const auto scans = sixScans(sphere(5), GetParam());
  constexpr double kVoxel = 0.05;
  const fuse::Fused result = fused(scans, closed(kVoxel));
  ASSERT_GT(result.mesh.triangleCount(), 10000u);
  EXPECT_EQ(openEdges(result.mesh), 0u);
  EXPECT_EQ(eulerOf(result.mesh), 2) << "one component without a handle";
  EXPECT_EQ(result.measured, result.mesh.vertexCount()) << "six scans see all of a sphere";
  double worst = 0;
  for (std::size_t v = 0; v < result.mesh.vertexCount(); ++v)
    worst = std::max(worst, std::abs(radiusAt(result.mesh, v) - 1));
  EXPECT_LT(worst, 0.2 * kVoxel);
  const float* normals = result.mesh.find("normal")->values.data();
  for (std::size_t v = 0; v < result.mesh.vertexCount(); ++v)
    ASSERT_GT(render::mesh::dot(&result.mesh.positions[3 * v], normals + 3 * v), 0.9) << "outwards";
}
INSTANTIATE_TEST_SUITE_P(Scanners, FusedSphere,
                         testing::Values(Scanner::kOrthogonal, Scanner::kPinhole,
                                         Scanner::kSpinning));

TEST(Fuse, TheNumberOfThreadsChangesNothing) {
  const auto scans = sixScans(sphere(4), Scanner::kPinhole);
  const fuse::Fused one = fused(scans, closed(0.08)), three = fused(scans, closed(0.08), 3);
  EXPECT_EQ(one.mesh.positions, three.mesh.positions);
  EXPECT_EQ(one.mesh.triangles, three.mesh.triangles);
  for (std::size_t i = 0; i < one.mesh.features.size(); ++i)
    EXPECT_EQ(one.mesh.features[i].values, three.mesh.features[i].values);
}

TEST(Fuse, OneScanStaysOpenAndDoesNotBridgeADepthEdge) {
  // A plate in front of a wall: the scanner sees the plate and the wall around it.
  Mesh mesh = grid(4, 4);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i] = i % 3 == 2 ? -1.5F : mesh.positions[i] - 2;
  const Mesh plate = grid(1, 1);
  const auto first = static_cast<std::uint32_t>(mesh.vertexCount());
  for (std::size_t i = 0; i < plate.positions.size(); ++i)
    mesh.positions.push_back(i % 3 == 2 ? 0.0F : plate.positions[i] - 0.5F);
  for (const std::uint32_t v : plate.triangles) mesh.triangles.push_back(first + v);
  fuse::FuseSettings settings;
  settings.voxel = 0.05;
  const fuse::Fused result = fused({scanFrom(mesh, Scanner::kOrthogonal, {0, 0, 5})}, settings);
  ASSERT_GT(result.mesh.triangleCount(), 1000u);
  EXPECT_GT(openEdges(result.mesh), 100u);
  std::size_t front = 0, back = 0;
  for (std::size_t v = 0; v < result.mesh.vertexCount(); ++v) {
    const double z = double{result.mesh.positions[3 * v + 2]};
    front += std::abs(z) < 0.02;
    back += std::abs(z + 1.5) < 0.02;
  }
  EXPECT_GT(front, 400u);
  EXPECT_GT(back, 400u);
  EXPECT_EQ(front + back, result.mesh.vertexCount()) << "nothing between the plate and the wall";
}

TEST(Fuse, ConfidenceSaysWhichColourCounts) {
  const Mesh mesh = sphere(4);
  std::vector<range::RangeImage> scans = {scanFrom(mesh, Scanner::kPinhole, {0, 0, 5}),
                                          scanFrom(mesh, Scanner::kPinhole, {0, 0, 5})};
  for (std::size_t i = 0; i < 2; ++i) {
    range::RangeImage& image = scans[i];
    image.planes.clear();
    image.planes.push_back({"heat", 1, std::vector<float>(image.pixels(), i == 0 ? 0.F : 8.F)});
    image.planes.push_back({"label", 1, std::vector<float>(image.pixels(), i == 0 ? 3.F : 4.F)});
    image.planes.push_back({"confidence", 1, std::vector<float>(image.pixels(), 1.F)});
    // The pixel in the corner has the confidence 1; all others have a quarter of it.
    if (i == 0) std::fill_n(image.planes[2].values.begin() + 1, image.pixels() - 1, 0.25F);
  }
  fuse::FuseSettings settings;
  settings.voxel = 0.08;
  const fuse::Fused result = fused(scans, settings);
  ASSERT_NE(result.mesh.find("heat"), nullptr);
  for (const float heat : result.mesh.find("heat")->values) ASSERT_NEAR(heat, 6.4, 1e-3);
  for (const float label : result.mesh.find("label")->values) ASSERT_EQ(label, 4);
}

TEST(Fuse, RefusesWhatTheMemoryDoesNotHoldAndNamesAVoxelThatFits) {
  const auto scans = sixScans(sphere(4), Scanner::kPinhole);
  fuse::FuseSettings settings = closed(0.01);
  settings.memory = std::size_t{16} << 20;
  const auto refused = fuse::fuse(scans, settings, {1});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, Errc::kInvalidArgument);
  const std::size_t at = refused.error().what.find("--voxel ");
  ASSERT_NE(at, std::string::npos) << refused.error().what;
  settings.voxel = std::stod(refused.error().what.substr(at + 8));
  EXPECT_LT(settings.voxel, 0.1);
  EXPECT_TRUE(fuse::fuse(scans, settings, {1}).ok());
}

TEST(Fuse, RefusesScansWhoseRaysHaveNoInverse) {
  range::RangeImage image;
  image.width = image.height = 4;
  image.geometry.scanner = Scanner::kElevation;
  EXPECT_NE(fuse::faultOf(image).find("elevation map"), std::string::npos);
  image.geometry.scanner = Scanner::kSpinning;
  image.geometry.horizontal_rad = 1;
  image.geometry.beams = {{0.1, 0}, {0.2, 0}, {0.0, 0}, {-0.1, 0}};
  EXPECT_NE(fuse::faultOf(image).find("row 2 "), std::string::npos);
}

}  // namespace
}  // namespace merlin::test
