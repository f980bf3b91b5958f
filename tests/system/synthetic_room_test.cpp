// Correction of real signals in a synthetic room: projectors with known properties project the
// daemon's signals, a known camera photographs them, and the photographs are measured. The
// correction follows from the known room (through the configuration, and through an MPCDI file),
// and once from photographs alone (through `merlin wall align`). The test prints the figures before
// and after.
//
// If the environment variable MERLIN_PICTURES is set, the photographs are written into that folder.
#include "tests/support/synthetic_room.h"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include <Eigen/SVD>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/image/image_file.h"
#include "render/image/png_writer.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;
using nlohmann::json;

// The test card "grid" has a line at every 40th pixel of a tile of this size.
constexpr int kWidth = 641, kHeight = 481, kSpacing = 40, kColumns = 16, kRows = 12;
// [px]; four cells and one pixel, so that lines of both tiles coincide
constexpr int kOverlap = 161;
constexpr double kPixel = 0.0025;  // width of a pixel on the wall [m]
constexpr int kCameraWidth = 1800, kCameraHeight = 860;
constexpr double kLowest = 0.8, kDistance = -3;  // height of the wall's lower edge, and its z [m]

// A crossing of grid lines that is measured. The outermost lines are left out, since the blend
// ramps make them dark.
struct Crossing {
  int column, row;
  Vector2d pixel() const { return {column * kSpacing + 0.5, row * kSpacing + 0.5}; }
};

// A line's place is the mean over points at these distances [px] from the crossing: the signal is
// filtered before its gamma is applied, which moves a line of one pixel width by up to 0.2 pixels,
// depending on its phase.
constexpr double kAsides[] = {-20, -17.5, -15, -12.5, -10, 10, 12.5, 15, 17.5, 20};
constexpr double kReach = 8;  // search range on each side of a line [px]

// Returns whether a diagonal of the card is near the points at which the lines of the crossing `at`
// are measured.
bool isOnDiagonal(const Vector2d& at) {
  const double slope = 1.0 * (kHeight - 1) / (kWidth - 1);
  for (const double turn : {1.0, -1.0}) {
    for (const double aside : kAsides) {
      const auto diagonalAt = [&](double x) {
        return kHeight / 2.0 + turn * slope * (x - kWidth / 2.0);
      };
      const double off = at.y() + aside - diagonalAt(at.x());
      if (std::abs(off) / slope < kReach + 3) return true;
      if (std::abs(at.y() - diagonalAt(at.x() + aside)) < kReach + 3) return true;
    }
  }
  return false;
}

// Returns whether another part of the card is near the crossing: a diagonal, a circle, the name in
// the middle, or the mark of the corner that is being moved.
bool isDisturbed(const Crossing& c) {
  const Vector2d at = c.pixel(), middle(kWidth / 2.0, kHeight / 2.0);
  const Vector2d from_border = at.cwiseMin(Vector2d(kWidth, kHeight) - at),
                 small_centre = Vector2d::Constant(kHeight / 8.0);
  const double to_circle = std::abs((at - middle).norm() - kHeight / 2.0);
  const double to_small = std::abs((from_border - small_centre).norm() - kHeight / 8.0);
  const bool in_name = std::abs(at.x() - middle.x()) < 120 && std::abs(at.y() - middle.y()) < 30;
  return to_circle < 28 || to_small < 28 || in_name || from_border.maxCoeff() < 2.5 * kSpacing ||
         isOnDiagonal(at);
}

std::vector<Crossing> crossings() {
  std::vector<Crossing> all;
  for (int row = 1; row < kRows; ++row) {
    for (int column = 1; column < kColumns; ++column) {
      if (!isDisturbed({column, row})) all.push_back({column, row});
    }
  }
  return all;
}

struct Geometry {
  // Largest error of any crossing, and largest difference across the seam [px].
  double most = 0, seam = 0;
  std::size_t found = 0;
};

// Returns the homography from pixels of the uncorrected picture to metres on the panel, by least
// squares.
Eigen::Matrix3d fitHomography(const std::vector<std::pair<Vector2d, Vector2d>>& pairs) {
  Eigen::MatrixXd a(2 * static_cast<Eigen::Index>(pairs.size()), 9);
  Eigen::Index row = 0;
  for (const auto& [pixel, place] : pairs) {
    const Eigen::RowVector3d p(pixel.x() / kWidth, pixel.y() / kHeight, 1);
    a.row(row++) << p, Eigen::RowVector3d::Zero(), -place.x() * p;
    a.row(row++) << Eigen::RowVector3d::Zero(), p, -place.y() * p;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullV);
  const Eigen::VectorXd h = svd.matrixV().col(8);
  Eigen::Matrix3d H;
  H << h.segment<3>(0).transpose(), h.segment<3>(3).transpose(), h.segment<3>(6).transpose();
  return H * Eigen::DiagonalMatrix<double, 3>(1.0 / kWidth, 1.0 / kHeight, 1);
}

class SyntheticRoom : public testing::Test {
 protected:
  // Sets up two projectors on a plane screen or, if `hinged`, one on each of two panels that meet
  // at 160 degrees.
  void build(bool hinged, double distortion) {
    hinged_ = hinged;
    const double width = kWidth * kPixel, height = kHeight * kPixel;
    const double overlap = hinged ? 0 : kOverlap * kPixel;
    const double margin = hinged ? 0 : 0.2;  // margin of the panel around the wall's picture [m]
    const double turn = hinged ? 10 * std::numbers::pi / 180 : 0;
    const Vector3d middle(0, kLowest + height, kDistance), down(0, -1, 0);
    for (const int side : {-1, 1}) {
      const Vector3d right(std::cos(turn), 0, side * std::sin(turn));
      Panel panel{middle, right, down, width, height};
      if (side < 0) panel.upper_left = middle - width * right;
      if (!hinged) {
        panel = {middle - (width - overlap / 2 + margin) * right - margin * down, right, down,
                 2 * (width + margin) - overlap, height + 2 * margin};
      }
      if (hinged || panels_.empty()) panels_.push_back(panel);
      Projector p;
      p.width = kWidth;
      p.height = kHeight;
      p.panel = panels_.back();
      p.part = {margin + (!hinged && side > 0 ? width - overlap : 0), margin, width, height};
      const Vector3d centre = p.placeOf(kWidth / 2.0, kHeight / 2.0);
      p.lens = lensAt(centre + Vector3d(0.3 * side, 0.35, 2.6), centre - Vector3d(0.02, 0.05, 0),
                      0.8 * side);
      p.lens.distortion = distortion;
      p.gamma = side < 0 ? Light(2.2, 2.2, 2.3) : Light(2.1, 2.25, 2.2);
      p.full = side < 0 ? Light(0.94, 1, 0.97) : Light(1, 0.92, 0.9);
      p.black = 0.004;
      p.zoom(4);
      projectors_.push_back(p);
    }
    camera_ = lensAt({0.15, 1.7, 0.6}, middle - Vector3d(0, height / 2, 0), 0.5);
    camera_.focal = 1700;
    camera_.centre = {kCameraWidth / 2.0, kCameraHeight / 2.0};
  }

  // Starts the wall. `corrections`: one for each projector; null: no correction.
  void start(const std::vector<json>& corrections) {
    wall_.reset();
    json panels = json::array(), displays = json::array(), outputs = json::array();
    for (std::size_t i = 0; i < panels_.size(); ++i) {
      json panel = {{"name", fmt::format("panel_{}", i)},
                    {"width_m", panels_[i].width},
                    {"height_m", panels_[i].height}};
      const Vector3d low = panels_[i].at(0, panels_[i].height);
      if (i == 0) panel.update({{"lower_left_m", {low.x(), low.y(), low.z()}}});
      if (i == 0 && hinged_) panel["yaw_deg"] = 10;
      if (i > 0) panel["hinge_deg"] = 160;
      panels.push_back(panel);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      displays.push_back({{"name", kNames[i]},
                          {"panel", fmt::format("panel_{}", hinged_ ? i : 0)},
                          {"part_m", projectors_[i].part},
                          {"width", kWidth},
                          {"height", kHeight}});
      outputs.push_back({{"kind", "png"},
                         {"name", kNames[i]},
                         {"path", dir_ / (std::string(kNames[i]) + ".png")},
                         {"interval_s", 86400},
                         {"tiles", json::array({{{"tile", kNames[i]}}})}});
      if (!corrections.empty()) outputs.back()["correction"] = corrections[i];
    }
    outputs.push_back({{"kind", "shared_memory"}});
    MerlindOptions options;
    options.script = "still";
    options.also = {
        {"wall",
         {{"scene", {{"model_distance_m", 1000}}},
          {"render", {{"background", {0.87, 0.87, 0.87}}}},
          {"room", {{"panels", panels}, {"displays", displays}, {"eye_m", {0, 1.6, 0}}}},
          {"outputs", outputs}}}};
    wall_ = std::make_unique<Merlind>(dir_, model_, "room", options);
    ASSERT_TRUE(wall_->ready()) << wall_->process().output();
  }
  const std::string& config() const { return wall_->config(); }

  Outcome merlin(std::vector<std::string> words) const {
    words.insert(words.begin(), kMerlin);
    words.insert(words.end(), {"--instance", wall_->instance()});
    Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return outcome;
  }
  void show(const std::string& card) const { merlin({"wall", "testcard", card}); }

  // Takes a photograph of the signals that the wall sends now.
  Photograph photograph(const std::vector<bool>& lit = {true, true}) {
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string file = dir_ / "signal.png";
      merlin({"snapshot", "--output", kNames[i], "-o", file});
      auto read = render::image::readImage(file);
      EXPECT_TRUE(read && read->width == kWidth && read->height == kHeight);
      projectors_[i].signal = read->pixels;
    }
    return Photograph(camera_, kCameraWidth, kCameraHeight, panels_, projectors_, lit);
  }
  static std::vector<bool> only(std::size_t projector) { return {projector == 0, projector == 1}; }

  // Returns the place of a crossing of grid lines as the camera sees it, in metres on the panel.
  // `guess` has to be within 8 pixels of it.
  std::optional<Vector2d> find(const Photograph& photo, std::size_t projector,
                               Vector2d guess) const {
    const Panel& panel = projectors_[projector].panel;
    const double reach = kReach * kPixel;
    for (int round = 0; round < 3; ++round) {
      Vector2d off = Vector2d::Zero();
      for (const double aside : kAsides) {
        const double to = aside * kPixel;
        const auto x = findLine(photo, panel.at(guess.x(), guess.y() + to), reach * panel.right);
        const auto y = findLine(photo, panel.at(guess.x() + to, guess.y()), reach * panel.down);
        if (!x || !y) return std::nullopt;
        off += Vector2d(*x, *y) * reach / static_cast<double>(std::size(kAsides));
      }
      guess += off;
    }
    return guess;
  }
  Vector2d onPanel(std::size_t projector, const Vector3d& place) const {
    const Panel& panel = projectors_[projector].panel;
    return {(place - panel.upper_left).dot(panel.right),
            (place - panel.upper_left).dot(panel.down)};
  }
  Vector2d truth(std::size_t projector, const Vector2d& pixel) const {
    return onPanel(projector, projectors_[projector].placeOf(pixel.x(), pixel.y()));
  }

  // Measures the errors of the grid's crossings while the wall shows the card "grid".
  Geometry measureGrid(bool corrected) {
    Geometry result;
    std::map<std::pair<int, int>, Vector2d> beside_seam[2];
    for (std::size_t i = 0; i < 2; ++i) {
      const Photograph photo = photograph(only(i));
      for (const Crossing& c : crossings()) {
        const Vector2d wanted = truth(i, c.pixel());
        const Vector2d guess = corrected ? wanted : onPanel(i, projectors_[i].target(c.pixel()));
        const auto found = find(photo, i, guess);
        if (!found) continue;
        ++result.found;
        const Vector2d error = (*found - wanted) / kPixel;
        result.most = std::max(result.most, error.norm());
        // Compares lines that coincide in the overlap, or the lines nearest to the hinge.
        const int first = hinged_ ? kColumns - 2 : kColumns - kOverlap / kSpacing;
        const int column = i == 0 ? c.column - first : c.column;
        if (column >= 1 && column <= kColumns - 1 - first) beside_seam[i][{column, c.row}] = error;
      }
    }
    for (const auto& [place, error] : beside_seam[0]) {
      const auto other = beside_seam[1].find(place);
      if (other == beside_seam[1].end()) continue;
      result.seam = std::max(result.seam, (error - other->second).norm());
      ++seam_pairs_;
    }
    return result;
  }

  // Returns the largest deviation of the luminance from its mean [%], over blocks of 8 x 8 pixels,
  // while the wall shows its background.
  double measureLight() {
    const Photograph photo = photograph();
    write(photo, "light");
    std::vector<double> luminance;
    for (const Projector& p : projectors_) {
      for (int y = 8; y + 16 <= kHeight; y += 8) {
        for (int x = 8; x + 16 <= kWidth; x += 8) {
          Light sum = Light::Zero();
          for (int k = 0; k < 16; ++k)
            sum += photo.at(p.placeOf(x + 1 + 2 * (k % 4), y + 1 + 2 * (k / 4))) / 16;
          luminance.push_back(sum.matrix().dot(Vector3d(0.2126, 0.7152, 0.0722)));
        }
      }
    }
    double mean = 0, most = 0;
    for (const double l : luminance) mean += l / static_cast<double>(luminance.size());
    for (const double l : luminance) most = std::max(most, std::abs(l / mean - 1));
    return 100 * most;
  }

  struct Figures {
    Geometry grid;
    double light = 0;
  };
  Figures measure(const std::string& name, bool corrected) {
    name_ = name;
    seam_pairs_ = 0;
    Figures f;
    show("grid");
    f.grid = measureGrid(corrected);
    write(photograph(), "grid");
    show("off");
    f.light = measureLight();
    fmt::print("{:32} place {:6.2f} px, seam {:6.2f} px, luminance {:6.3f} % ({} crossings)\n",
               name, f.grid.most, f.grid.seam, f.light, f.grid.found);
    EXPECT_GE(f.grid.found, 2 * crossings().size() - 30);
    EXPECT_GE(seam_pairs_, corrected ? 5u : 0u);
    return f;
  }
  static void expectRight(const Figures& f) {
    EXPECT_LE(f.grid.seam, 0.5);
    EXPECT_LE(f.grid.most, 0.5);
    EXPECT_LE(f.light, 1);
  }

  // Returns the settings that a person would find by measuring the light of projector `i`.
  json light(std::size_t i) const {
    const Projector& p = projectors_[i];
    const Light least = projectors_[0].full.min(projectors_[1].full);
    const Light other = projectors_[1 - i].full;
    const Light gain = least / p.full, gamma = p.gamma / 2.2;
    json correction = {
        {"colour",
         {{"gain", {gain[0], gain[1], gain[2]}}, {"gamma", {gamma[0], gamma[1], gamma[2]}}}}};
    if (hinged_) return correction;
    const Light level = p.black / (1 - p.black) * other / p.full;
    correction["blend"] = {{i == 0 ? "right" : "left", kOverlap}};
    correction["black"] = {{"level", {level[0], level[1], level[2]}}};
    return correction;
  }
  json withCorners(std::size_t i) const {
    json correction = light(i), corners = json::array();
    for (const double y : {0, kHeight}) {
      for (const double x : {0, kWidth}) {
        const Vector2d at = projectors_[i].lens.pixelOf(projectors_[i].placeOf(x, y));
        corners.push_back(at.x() - x);
        corners.push_back(at.y() - y);
      }
    }
    correction["corners"] = corners;
    return correction;
  }
  json withMesh(std::size_t i) const {
    json correction = light(i), points = json::array();
    constexpr int kMeshColumns = 17, kMeshRows = 13;
    for (int row = 0; row < kMeshRows; ++row) {
      for (int column = 0; column < kMeshColumns; ++column) {
        const Vector2d at = projectors_[i].lens.pixelOf(projectors_[i].placeOf(
            1.0 * kWidth * column / (kMeshColumns - 1), 1.0 * kHeight * row / (kMeshRows - 1)));
        points.push_back({{"x", at.x() / kWidth}, {"y", at.y() / kHeight}});
      }
    }
    correction["mesh"] = {{"columns", kMeshColumns}, {"rows", kMeshRows}, {"points", points}};
    return correction;
  }

  void write(const Photograph& photo, const std::string& what) const {
    if (const char* folder = std::getenv("MERLIN_PICTURES")) {
      const std::vector<std::uint8_t> pixels = photo.pixels();
      EXPECT_TRUE(render::image::writePng(fmt::format("{}/{} {}.png", folder, name_, what),
                                          kCameraWidth, kCameraHeight, pixels));
    }
  }

  static constexpr const char* kNames[] = {"left", "right"};
  TempDir dir_;
  std::string model_ = makeModel(dir_, 2);
  bool hinged_ = false;
  std::vector<Panel> panels_;
  std::vector<Projector> projectors_;
  Lens camera_;
  std::size_t seam_pairs_ = 0;
  std::string name_;
  std::unique_ptr<Merlind> wall_;
};

TEST_F(SyntheticRoom, IsRightByTheConfigurationOnAPlaneScreen) {
  build(false, 0);
  start({});
  const Figures before = measure("plane before", false);
  EXPECT_GT(before.grid.seam, 2);
  EXPECT_GT(before.light, 20);
  start({withCorners(0), withCorners(1)});
  expectRight(measure("plane corners blend colour", true));
}

// Aligns as a script would that has only photographs: first by the coloured corners of the card
// "edges", then by the lines of the card "grid".
class AlignedRoom : public SyntheticRoom {
 protected:
  // Distance of a mark's centroid from its corner along each side [px]; the mark has two arms of 60
  // x 6 pixels.
  static constexpr double kMark = (360 * 31 + 360 * 4 - 36 * 4) / 684.0;

  // Returns the homography from pixels of the picture to metres on the panel, fitted to the
  // corners' marks.
  Eigen::Matrix3d fitMarks(std::size_t projector) {
    const Photograph photo = photograph(only(projector));
    const Panel& panel = projectors_[projector].panel;
    std::array<Vector3d, 4> sums{};  // weighted sum of places, and sum of weights
    sums.fill(Vector3d::Zero());
    for (double y = 0; y < panel.height; y += kPixel) {
      for (double x = 0; x < panel.width; x += kPixel) {
        const Light l = photo.at(panel.at(x, y));
        // Excludes the mark of the corner that is being moved, which is orange.
        const std::array<double, 4> purity = {
            l[0] - 8 * std::max(l[1], l[2]), l[1] - std::max(l[0], l[2]),
            l[2] - std::max(l[0], l[1]), std::min(l[0], l[1]) - l[2]};
        for (std::size_t k = 0; k < 4; ++k) {
          const double weight = purity[k] > 0.3 ? purity[k] : 0;
          sums[k] += weight * Vector3d(x, y, 1);
        }
      }
    }
    std::vector<std::pair<Vector2d, Vector2d>> pairs;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector2d mark(k % 2 == 0 ? kMark : kWidth - kMark,
                          k / 2 == 0 ? kMark : kHeight - kMark);
      EXPECT_GT(sums[k].z(), 0);
      pairs.emplace_back(mark, sums[k].head<2>() / sums[k].z());
    }
    return fitHomography(pairs);
  }
  // Returns the homography fitted to all lines of the grid; `about` is an estimate of it, with an
  // error of at most 8 pixels.
  Eigen::Matrix3d fitGrid(std::size_t projector, const Eigen::Matrix3d& about) {
    const Photograph photo = photograph(only(projector));
    std::vector<std::pair<Vector2d, Vector2d>> pairs;
    for (const Crossing& c : crossings()) {
      const Vector2d guess = (about * c.pixel().homogeneous()).hnormalized();
      if (const auto found = find(photo, projector, guess)) pairs.emplace_back(c.pixel(), *found);
    }
    EXPECT_GT(pairs.size(), crossings().size() / 2);
    return fitHomography(pairs);
  }
  // Moves each corner by its present error; returns the largest error [px].
  double moveCorners(std::size_t projector, const Eigen::Matrix3d& seen) {
    constexpr const char* kCorners[] = {"top_left", "top_right", "bottom_left", "bottom_right"};
    double most = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector2d corner(k % 2 == 0 ? 0 : kWidth, k / 2 == 0 ? 0 : kHeight);
      const Vector2d error =
          ((seen * corner.homogeneous()).hnormalized() - truth(projector, corner)) / kPixel;
      most = std::max(most, error.norm());
      merlin({"wall", "align", "--output", kNames[projector], "--corner", kCorners[k], "--by",
              fmt::format("{:.3f}", -error.x()), fmt::format("{:.3f}", -error.y())});
    }
    EXPECT_TRUE(eventually([&] {
      const json all = json::parse(merlin({"wall", "align", "--list", "--json"}).output);
      return !all["outputs"][projector]["pending"].get<bool>();
    }));
    return most;
  }
};

TEST_F(AlignedRoom, IsRightByAlignAloneAndAfterARestart) {
  build(false, 0);
  start({});
  int rounds = 0;
  double most = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    show("edges");
    Eigen::Matrix3d seen = fitMarks(i);
    const double first = moveCorners(i, seen);
    EXPECT_GT(first, 5);
    fmt::print("align {}: {:.2f}", kNames[i], first);
    // By now the picture is nearly at its right place.
    seen = fitHomography({{{0, 0}, truth(i, {0, 0})},
                          {{kWidth, 0}, truth(i, {kWidth, 0})},
                          {{0, kHeight}, truth(i, {0, kHeight})},
                          {{kWidth, kHeight}, truth(i, {kWidth, kHeight})}});
    show("grid");
    for (rounds = 0, most = 1; most > 0.05 && rounds < 8; ++rounds) {
      seen = fitGrid(i, seen);
      most = moveCorners(i, seen);
      fmt::print(", {:.2f}", most);
    }
    fmt::print(" px\n");
    EXPECT_LE(most, 0.1);
  }
  // The configuration sets the light; the corners come from the daemon's state.
  start({light(0), light(1)});
  expectRight(measure("plane by align alone", true));
}

TEST_F(SyntheticRoom, IsRightByTheConfigurationWhereLensesDistort) {
  build(false, -0.08);
  start({});
  EXPECT_GT(measure("lens before", false).grid.seam, 2);
  start({withMesh(0), withMesh(1)});
  expectRight(measure("lens mesh blend colour", true));

  // The correction of the same room comes through an MPCDI file. The file has no colour, so that
  // the colour remains in the configuration.
  const std::string file = dir_ / "room.mpcdi", settings = dir_ / "correction.json";
  ASSERT_EQ(run({kMerlin, "wall", "mpcdi", "export", file, "-c", config()}).status, 0);
  ASSERT_EQ(run({kMerlin, "wall", "mpcdi", "import", file, "-o", settings}).status, 0);
  const json imported = json::parse(readText(settings));
  std::vector<json> corrections;
  for (std::size_t i = 0; i < 2; ++i) {
    corrections.push_back(imported[kNames[i]]["correction"]);
    corrections[i].merge_patch({{"colour", light(i)["colour"]}});
  }
  start(corrections);
  expectRight(measure("lens MPCDI colour", true));
}

TEST_F(SyntheticRoom, IsRightByTheConfigurationOnAHingedScreen) {
  build(true, -0.08);
  start({});
  EXPECT_GT(measure("hinged before", false).grid.most, 2)
      << "the lines at the hinge miss the panel";
  start({withMesh(0), withMesh(1)});
  expectRight(measure("hinged mesh colour", true));
}

}  // namespace
}  // namespace merlin::test
