// The simulated scanner: rays, round trips of known shapes through files, noise, modalities.
#include "render/scan/scan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/compare/farthest.h"
#include "render/compare/triangle_tree.h"
#include "render/range/geometry.h"
#include "render/range/io/plane_file.h"
#include "render/range/io/range_file.h"
#include "render/range/triangulate.h"
#include "render/scan/placement.h"
#include "tests/support/meshes.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {
namespace {

namespace compare = render::compare;
namespace range = render::range;
namespace scan = render::scan;
using range::Scanner;

constexpr double kDeg = std::numbers::pi / 180;

scan::ScanSettings settingsFor(const Mesh& mesh, Scanner scanner) {
  scan::ScanSettings settings;
  settings.width = 120;
  settings.height = 100;
  range::Geometry& g = settings.geometry;
  g.scanner = scanner;
  g.horizontal_rad = 36 * kDeg;
  g.vertical_rad = 30 * kDeg;
  g.T_world_scanner =
      scan::around(render::mesh::boundingBox(mesh.positions), 30 * kDeg, 20 * kDeg, g);
  if (scanner != Scanner::kSpinning) return settings;
  g.beams = range::evenBeams(g.vertical_rad, settings.height);
  g.vertical_rad = 0;
  return settings;
}

scan::Scan scanned(const Mesh& mesh, const scan::ScanSettings& settings, unsigned threads = 1) {
  auto result = scan::scan({mesh}, settings, {threads});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().what);
  return result.ok() ? *std::move(result) : scan::Scan{};
}

// Returns settings of a scanner at the origin with orthogonal rays, 90 x 90 degrees, one metre from
// the wall().
scan::ScanSettings ahead(std::size_t width, std::size_t height) {
  scan::ScanSettings settings;
  settings.width = width;
  settings.height = height;
  settings.geometry.horizontal_rad = settings.geometry.vertical_rad = 90 * kDeg;
  return settings;
}
Mesh wall() {
  Mesh mesh = grid(4, 4);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i] = i % 3 == 2 ? -1.0F : mesh.positions[i] - 2;
  return mesh;
}

// In earlier versions, the ranges of a model without a unit were read back as metres.
TEST(ScanFile, KeepsTheUnitOfTheModelOrNone) {
  const TempDir dir;
  range::RangeImage image;
  image.width = image.height = 2;
  image.range = {1, 2, 3, 4};
  image.geometry.horizontal_rad = image.geometry.vertical_rad = 0.1;
  for (const bool metres : {true, false}) {
    image.unit = metres ? "m" : "";
    ASSERT_TRUE(range::writeRange(dir / "a.pgm", image).ok());
    const auto read = range::readRange(dir / "a.pgm", {});
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(read->in_metres, metres);
    EXPECT_EQ(read->image.unit, image.unit);
  }
}

TEST(Ray, FromInsideAClosedSurfaceMeetsItEvenAtItsCornersAndEdges) {
  const Mesh mesh = sphere(3);
  const compare::TriangleTree tree(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t next = t % 3 == 2 ? t - 2 : t + 1;
    const auto a = compare::vectorAt(&mesh.positions[3 * std::size_t{mesh.triangles[t]}]);
    const auto b = compare::vectorAt(&mesh.positions[3 * std::size_t{mesh.triangles[next]}]);
    for (const double share : {0.0, 0.5, 0.3}) {
      const compare::Vector to = a + share * (b - a), from{0.05, -0.02, 0.03};
      const auto met = tree.firstAlong(compare::Ray(from, to - from));
      ASSERT_NE(met.place, compare::TriangleTree::kNone) << t << " " << share;
      ASSERT_NEAR(met.hit.distance, 1, 1e-12);
    }
  }
}

TEST(Ray, MeetsTheNearestTriangleOfAllOnItsWay) {
  const Mesh mesh = noisyGrid(30, 20, 2, 5);
  const compare::TriangleTree tree(mesh);
  Random random(3);
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const compare::Vector from{random.uniform(-5, 35), random.uniform(-5, 25),
                               random.uniform(-5, 5)};
    const compare::Vector to{random.normal(), random.normal(), i % 7 == 0 ? 0 : random.normal()};
    const compare::Ray ray(from, to);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t place = 0; place < tree.size(); ++place) {
      const auto hit = ray.hit(tree.cornersAt(place));
      if (hit) nearest = std::min(nearest, hit->distance);
    }
    const auto first = tree.firstAlong(ray);
    ASSERT_EQ(first.hit.distance, nearest) << i;
    if (first.place == compare::TriangleTree::kNone) continue;
    ++met;
    const auto corners = tree.cornersAt(first.place);
    compare::Vector at{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) at += first.hit.barycentric[k] * corners[k];
    ASSERT_NEAR((at - from - nearest * to).norm(), 0, 1e-11) << "the barycentric coordinates";
  }
  EXPECT_GT(met, 500);
}

// A mesh that was scanned, written, read, and triangulated, as merlin mesh import does.
struct RoundTrip {
  range::RangeImage image;
  Mesh mesh;
  double range_step = 0;  // step of the ranges in the file [units]
  double step = 0;        // distance between neighbouring pixels at the farthest range [units]
};
RoundTrip roundTrip(const Mesh& mesh, Scanner scanner) {
  const TempDir dir;
  const auto taken = scanned(mesh, settingsFor(mesh, scanner));
  EXPECT_TRUE(range::writeRange(dir / "a.pgm", taken.image).ok());
  auto read = range::readRange(dir / "a.pgm", {});
  EXPECT_TRUE(read.ok()) << read.error().what;
  RoundTrip trip;
  trip.image = std::move(read->image);
  range::Threshold edge;
  edge.per_range = static_cast<float>(10 * range::stepOf(trip.image));
  trip.mesh = range::triangulate(trip.image, range::pointsOf(trip.image, {}), edge, {}).mesh;
  float low = range::kFarthest, high = 0;
  for (const float r : trip.image.range) {
    if (range::isReturn(r)) low = std::min(low, r), high = std::max(high, r);
  }
  trip.range_step = (double{high} - low) / 65534;
  trip.step = range::stepOf(trip.image) * high;
  return trip;
}

// Expects that each vertex lies within half a step of the file's ranges from the model, and that
// each point of the model's surface lies within one step between pixels from the mesh.
void expectWithinTheStep(const char* shape, const Mesh& model, Scanner scanner) {
  const RoundTrip trip = roundTrip(model, scanner);
  ASSERT_GT(trip.mesh.triangleCount(), 4000u);
  const compare::TriangleTree tree(model), own(trip.mesh);
  double vertices = 0;
  for (std::size_t v = 0; v < trip.mesh.vertexCount(); ++v)
    vertices = std::max(
        vertices, tree.nearest(compare::vectorAt(&trip.mesh.positions[3 * v])).point.distance2);
  vertices = std::sqrt(vertices);
  constexpr double kFloats = 1e-6;  // rounding of coordinates of a few units
  const auto surface =
      compare::farthest({trip.mesh, own}, {model, tree}, {trip.step / 1000, 5'000'000, 1},
                        [](double, std::size_t) { return true; });
  ASSERT_TRUE(surface);
  fmt::print(
      "  {} {:10}: vertices within {:.2g} (bound {:.2g}), surface within {:.3g} (bound: the "
      "step, {:.3g})\n",
      shape, range::nameOf(scanner), vertices, trip.range_step / 2 + kFloats, surface->high,
      trip.step);
  EXPECT_LE(vertices, trip.range_step / 2 + kFloats);
  EXPECT_GT(vertices, trip.range_step / 8) << "a bound that means something";
  EXPECT_LE(surface->high, trip.step);
}

TEST(ScanRoundTrip, ASphereComesBackWithinTheScannersStep) {
  for (const Scanner s : {Scanner::kOrthogonal, Scanner::kPinhole, Scanner::kSpinning})
    expectWithinTheStep("sphere", sphere(5), s);
}

TEST(ScanRoundTrip, ABoxComesBackWithinTheScannersStep) {
  for (const Scanner s : {Scanner::kOrthogonal, Scanner::kPinhole, Scanner::kSpinning})
    expectWithinTheStep("box   ", cube(), s);
}

TEST(ScanRoundTrip, TheGeometryComesBackFromTheHeader) {
  for (const Scanner s : {Scanner::kOrthogonal, Scanner::kPinhole, Scanner::kSpinning}) {
    const range::Geometry asked = settingsFor(cube(), s).geometry;
    const range::Geometry read = roundTrip(cube(), s).image.geometry;
    EXPECT_EQ(read.scanner, s);
    EXPECT_NEAR(read.horizontal_rad, asked.horizontal_rad, 1e-15);
    EXPECT_NEAR(read.vertical_rad, asked.vertical_rad, 1e-15);
    EXPECT_EQ(read.T_world_scanner, asked.T_world_scanner);
    EXPECT_EQ(read.beams.size(), asked.beams.size());
  }
}

TEST(ScanPlacement, TheImagesMiddleShowsWhatItLooksAt) {
  for (const scan::Point& from :
       {scan::Point{3, 4, 5}, scan::Point{0, 9, 0}, scan::Point{0, -9, 0}}) {
    const range::Pose pose = scan::lookAt(from, {0, 0, 0});
    const double away = std::hypot(from[0], from[1], from[2]);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(pose[4 * k + 3] - away * pose[4 * k + 2], 0, 1e-12) << "along -z of the scanner";
    EXPECT_GE(pose[5], 0) << "the y axis is up";
    scan::ScanSettings settings = ahead(3, 3);
    settings.geometry.T_world_scanner = pose;
    EXPECT_NEAR(scanned(sphere(4), settings).image.range[4], away - 1, 4e-3);
  }
}

TEST(ScanPlacement, TheSphereAroundTheModelFitsIntoTheSmallerAngle) {
  range::Geometry g;
  g.horizontal_rad = 90 * kDeg;
  g.vertical_rad = 60 * kDeg;
  const range::Pose pose = scan::around({{1, 1, 1}, {3, 3, 3}}, 0, -90 * kDeg, g);
  EXPECT_NEAR(pose[3], 2, 1e-12);
  EXPECT_NEAR(pose[7], 2 - std::sqrt(3.0) / 0.5, 1e-6) << "z is up: it stands at negative y";
  EXPECT_NEAR(pose[11], 2, 1e-12);
}

TEST(ScanFaults, NoiseHasTheDeviationThatWasAskedForAndNoOtherEffect) {
  scan::ScanSettings settings = ahead(101, 101);
  const auto exact = scanned(wall(), settings).image.range;
  settings.noise = 0.01;
  const auto noisy = scanned(wall(), settings).image.range;
  double sum = 0, squares = 0;
  for (std::size_t p = 0; p < exact.size(); ++p) {
    const double off = double{noisy[p]} - double{exact[p]};
    sum += off;
    squares += off * off;
  }
  const auto n = static_cast<double>(exact.size());
  EXPECT_NEAR(std::sqrt(squares / n), 0.01, 0.0003);
  EXPECT_NEAR(sum / n, 0, 0.0004);
}

TEST(ScanFaults, DropOutsAndObliqueSurfacesAreCounted) {
  scan::ScanSettings settings = ahead(100, 100);
  settings.drop_outs = 0.2;
  const auto taken = scanned(wall(), settings);
  EXPECT_EQ(taken.met, 10000u);
  EXPECT_NEAR(static_cast<double>(taken.lost), 2000, 150);
  const auto returns = std::count_if(taken.image.range.begin(), taken.image.range.end(),
                                     [](float r) { return range::isReturn(r); });
  EXPECT_EQ(static_cast<std::size_t>(returns) + taken.lost, taken.met);
  settings = ahead(101, 3);
  settings.geometry.vertical_rad = 1e-3;
  settings.most_incidence_rad = 22.7 * kDeg;  // half of the columns, 0.9 degrees each
  EXPECT_EQ(scanned(wall(), settings).oblique, 3u * 50u);
}

TEST(ScanFaults, TheSeedDecidesAndTheThreadsDoNot) {
  scan::ScanSettings settings = ahead(64, 48);
  settings.noise = 0.01;
  settings.drop_outs = 0.1;
  const auto bits = [](const scan::Scan& taken) {
    std::vector<float> ranges = taken.image.range;
    std::replace_if(
        ranges.begin(), ranges.end(), [](float r) { return !range::isReturn(r); }, 0);
    return ranges;
  };
  const auto one = bits(scanned(wall(), settings, 1));
  EXPECT_EQ(one, bits(scanned(wall(), settings, 4)));
  settings.seed = 2;
  EXPECT_NE(one, bits(scanned(wall(), settings)));
}

TEST(ScanFaults, AScannerThatLooksElsewhereIsAnError) {
  scan::ScanSettings settings = ahead(8, 8);
  // the scanner looks away from the wall
  settings.geometry.T_world_scanner = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0};
  EXPECT_EQ(scan::scan({wall()}, settings, {}).error().what, "none of the rays meets the mesh");
  settings.geometry.horizontal_rad = 4;
  EXPECT_EQ(scan::scan({wall()}, settings, {}).error().code, Errc::kInvalidArgument);
}

Mesh withFeatures() {
  Mesh mesh = wall();
  mesh.features = {{"normal", 3, std::vector<float>(75, 0)},
                   {"colour", 3, {}},
                   {"label", 1, {}},
                   {"heat", 1, {}},
                   {"flow", 2, std::vector<float>(50, 0)},
                   {"texcoord", 2, {}}};
  for (std::size_t v = 0; v < 25; ++v) {
    const float x = mesh.positions[3 * v], y = mesh.positions[3 * v + 1];
    for (const float c : {(x + 2) / 4, (y + 2) / 4, 0.5F}) mesh.find("colour")->values.push_back(c);
    mesh.find("label")->values.push_back(x < 0 ? 3 : 7);
    mesh.find("heat")->values.push_back(20 + 5 * x);
    for (const float c : {(x + 2) / 4, (y + 2) / 4}) mesh.find("texcoord")->values.push_back(c);
  }
  return mesh;
}

TEST(ScanModalities, FeaturesAreThoseOfThePlaceThatEachPixelShows) {
  const auto taken = scanned(withFeatures(), ahead(31, 31));
  const range::RangeImage& image = taken.image;
  const auto points = range::pointsOf(image, {});
  ASSERT_EQ(image.planes.size(), 4u);
  for (std::size_t p = 0; p < image.pixels(); ++p) {
    const float x = points[3 * p], y = points[3 * p + 1];
    ASSERT_NEAR(image.find("colour")->values[3 * p], (x + 2) / 4, 1e-5);
    ASSERT_NEAR(image.find("colour")->values[3 * p + 1], (y + 2) / 4, 1e-5);
    ASSERT_NEAR(image.find("heat")->values[p], 20 + 5 * x, 1e-4);
    ASSERT_NEAR(image.find("confidence")->values[p], 1 / std::hypot(x, y, 1.0F), 1e-5);
    const float label = image.find("label")->values[p];
    ASSERT_EQ(label, label < 5 ? 3.0F : 7.0F) << "never a label between two";
    if (std::abs(x + 0.5F) > 0.3F) {
      ASSERT_EQ(label, x < -0.5F ? 3.0F : 7.0F) << x;
    }
  }
  EXPECT_EQ(taken.left_out, std::vector<std::string>{"flow"});
}

TEST(ScanModalities, TheTextureGoesBeforeTheColoursOfVertices) {
  render::image::ImageFile texture{2, 1, {255, 0, 0, 0, 0, 255}};
  const Mesh mesh = withFeatures();
  auto taken = scan::scan({mesh, &texture}, ahead(31, 31), {});
  ASSERT_TRUE(taken.ok());
  const auto& colours = taken->image.find("colour")->values;
  EXPECT_GT(colours[3 * 15 * 31], 0.9F) << "red at the left";
  EXPECT_GT(colours[3 * 15 * 31 + 3 * 30 + 2], 0.7F) << "blue at the right";
  EXPECT_EQ(taken->left_out, (std::vector<std::string>{"colour", "flow"}));
}

TEST(ScanModalities, PlanesComeBackFromTheirFiles) {
  const TempDir dir;
  scan::ScanSettings settings = ahead(31, 31);
  settings.drop_outs = 0.1;
  const auto taken = scanned(withFeatures(), settings);
  const double tolerance[] = {0.5 / 255, 0, 20.0 / 65535, 0.5 / 65535};
  for (std::size_t i = 0; i < 4; ++i) {
    const range::Plane& plane = taken.image.planes[i];
    const std::string path = dir / (plane.name + range::endingOf(plane));
    ASSERT_TRUE(range::writePlane(path, plane, taken.image).ok());
    const auto read = range::readPlane(plane.name, path, taken.image);
    ASSERT_TRUE(read.ok()) << read.error().what;
    ASSERT_EQ(read->dimension, plane.dimension);
    for (std::size_t p = 0; p < plane.values.size(); ++p) {
      if (range::isReturn(taken.image.range[p / plane.dimension])) {
        ASSERT_NEAR(read->values[p], plane.values[p], tolerance[i] + 1e-6) << plane.name;
      }
    }
  }
}

TEST(ScanModalities, LabelsBelowZeroComeBackExactly) {
  const TempDir dir;
  auto taken = scanned(wall(), ahead(4, 4));
  range::Plane plane{"label", 1, {-5, 0, 7, 60000}};
  plane.values.resize(16, 1);
  ASSERT_TRUE(range::writePlane(dir / "a.pgm", plane, taken.image).ok());
  EXPECT_EQ(range::readPlane("label", dir / "a.pgm", taken.image)->values, plane.values);
}

TEST(ScanModalities, TheHeaderNamesTheFilesInItsOwnFolderOnly) {
  const TempDir dir;
  const auto taken = scanned(wall(), ahead(4, 4));
  ASSERT_TRUE(range::writeRange(dir / "a.pgm", taken.image, {{"heat", "a b.pgm"}}).ok());
  const auto read = range::readRange(dir / "a.pgm", {});
  ASSERT_EQ(read->features.size(), 1u);
  EXPECT_EQ(read->features[0].name, "heat");
  EXPECT_EQ(read->features[0].file, "a b.pgm");
  for (const char* bad :
       {"heat=/etc/passwd", "heat=../a.pgm", "heat=sub/a.pgm", "heat", "=a.pgm"}) {
    writeText(dir / "b.pgm", fmt::format("P5\n# angles: 9 9\n# feature: {}\n2 2\n255\nabcd", bad));
    const auto refused = range::readRange(dir / "b.pgm", {});
    ASSERT_FALSE(refused.ok()) << bad;
    EXPECT_NE(refused.error().what.find("line 3: feature: found"), std::string::npos)
        << refused.error().what;
  }
}

}  // namespace
}  // namespace merlin::test
