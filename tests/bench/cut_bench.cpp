// ./dev bench cut: any number of triangles of a large model: how long a cut takes beside a memcpy
// of what it returns, what it needs in memory, when the first picture of a cold file stands, and
// what a budget spent where the tiles look is worth, in pixels.
//
// The model: --hgt FILE, an elevation tile of 1201 x 1201 big-endian heights (SRTM 3), as it is
// (2.9 million triangles) or mirrored 2 x 2 (11.5 million; synthetic in that), reduced once and
// kept under --out; without the file, synthetic hills of the same size.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "daemon/wall/picture.h"
#include "render/lod/io/mrm_file.h"
#include "render/out/png.h"
#include "render/reduce/reduce.h"
#include "tests/support/statistics.h"

namespace merlin::bench {
namespace {

namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;
using render::Clusters;
using render::Dendrogram;
using render::Mesh;
using test::median;

constexpr std::size_t kSide = 1201;

double msSince(Steady::time_point then) {
  return std::chrono::duration<double, std::milli>(Steady::now() - then).count();
}

// Heights in metres, row by row; empty where there is no such file.
std::vector<float> readHeights(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<unsigned char> bytes(2 * kSide * kSide);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
    return {};
  std::vector<float> heights;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const auto raw = static_cast<std::int16_t>(bytes[i] << 8 | bytes[i + 1]);
    heights.push_back(raw == -32768 ? 0 : raw);  // a void
  }
  return heights;
}

std::vector<float> hills() {
  std::vector<float> heights;
  std::mt19937 random(1);
  for (std::size_t i = 0; i < kSide * kSide; ++i) {
    const auto x = static_cast<float>(i % kSide), y = static_cast<float>(i / kSide);
    const float wave = std::sin(x / 90) * std::cos(y / 70) + 0.3F * std::sin(x / 13 + y / 17);
    heights.push_back(400 * wave + static_cast<float>(random() % 100) / 25);
  }
  return heights;
}

// The heights mirrored `times` x `times`; posts are 66 m by 92.6 m apart (at 44 degrees north).
Mesh heightField(const std::vector<float>& heights, std::size_t times) {
  const std::size_t side = (kSide - 1) * times + 1;
  const auto mirrored = [&](std::size_t i) {
    const std::size_t in = i % (kSide - 1), tile = i / (kSide - 1);
    return tile % 2 == 0 ? in : kSide - 1 - in;
  };
  Mesh mesh;
  mesh.positions.reserve(3 * side * side);
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      const float height = heights[mirrored(y) * kSide + mirrored(x)];
      mesh.positions.insert(mesh.positions.end(),
                            {static_cast<float>(x) * 66, static_cast<float>(y) * -92.6F, height});
    }
  }
  for (std::uint32_t y = 0; y + 1 < side; ++y) {
    for (std::uint32_t x = 0; x + 1 < side; ++x) {
      const auto a = static_cast<std::uint32_t>(y * side + x), b = a + 1;
      const auto c = a + static_cast<std::uint32_t>(side), d = c + 1;
      mesh.triangles.insert(mesh.triangles.end(), {a, c, b, b, c, d});
    }
  }
  render::ensureNormals(mesh);
  return mesh;
}

bool makeModel(const std::vector<float>& heights, std::size_t times, const std::string& path) {
  if (fs::exists(path)) return true;
  fmt::print("making {} ...\n", path);
  std::fflush(stdout);
  const Mesh mesh = heightField(heights, times);
  const auto reduced = render::reduce(mesh, {});
  if (!reduced) return false;
  return render::writeMrm(path, render::buildDendrogram(mesh, reduced->log)).ok();
}

// --- cuts ----------------------------------------------------------------------------------------

// Budgets in random order, every cut beside a memcpy of what it returned.
void timeCuts(const Dendrogram& model) {
  const auto began = Steady::now();
  const Clusters clusters(model, {});
  fmt::print(
      "  index buffers and clusters: {:.0f} ms, {:.1f} MB beyond the file ({} clusters, "
      "ready from {} triangles down)\n",
      msSince(began), static_cast<double>(clusters.memoryBytes()) / (1 << 20), clusters.size(),
      model.trianglesAt(clusters.finestLevel()));
  const std::vector<std::size_t> budgets = {1'000,   5'000,   20'000,   37'213,
                                            100'000, 500'000, 1'000'000};
  std::vector<std::size_t> order;
  for (int i = 0; i < 21; ++i) {
    for (std::size_t b = 0; b < budgets.size(); ++b) order.push_back(b);
  }
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  std::vector<std::vector<double>> cut(budgets.size()), copy(budgets.size()), plain(budgets.size());
  std::vector<std::uint32_t> out(3 * budgets.back()), copied(out.size());
  for (const std::size_t b : order) {
    const std::size_t level = model.levelFor(budgets[b]);
    auto then = Steady::now();
    model.cut(level, out);
    plain[b].push_back(msSince(then));
    then = Steady::now();
    const std::size_t n = clusters.cutEvenly(level, out);
    cut[b].push_back(msSince(then));
    then = Steady::now();
    std::memcpy(copied.data(), out.data(), 12 * n);
    copy[b].push_back(msSince(then));
  }
  fmt::print("  {:>9} {:>10} {:>10} {:>7}   {}\n", "triangles", "cut ms", "memcpy ms", "ratio",
             "from the leaves, ms");
  for (std::size_t b = 0; b < budgets.size(); ++b) {
    fmt::print("  {:>9} {:>10.3f} {:>10.3f} {:>7.1f}   {:.3f}\n", budgets[b], median(cut[b]),
               median(copy[b]), median(cut[b]) / median(copy[b]), median(plain[b]));
  }
}

// --- pictures ------------------------------------------------------------------------------------

// Three tiles that touch and the operator's, 640 x 480 each.
render::TilePlan plan() {
  auto made = render::planTiles({});
  return *std::move(made);
}

// Low over the middle of the field, looking along it.
Eigen::Isometry3f closeUp() {
  Eigen::Isometry3f view = Eigen::Isometry3f::Identity();
  view.translate(Eigen::Vector3f(0.1F, -0.08F, 0.25F));
  view.rotate(Eigen::AngleAxisf(-1.3F, Eigen::Vector3f::UnitX()));
  view.rotate(Eigen::AngleAxisf(0.4F, Eigen::Vector3f::UnitZ()));
  return view;
}

std::unique_ptr<wall::Picture> pictureOf(const Dendrogram& model, bool view_dependent,
                                         const Clock& clock) {
  render::RenderSettings settings;
  settings.view_dependent = view_dependent;
  auto made = wall::Picture::make(model, plan(), settings, 1.5, clock);
  if (!made) {
    fmt::print("  no picture: {}\n", made.error().what);
    return nullptr;
  }
  return *std::move(made);
}

// The root of the mean square difference, 0..255, over the wall's tiles.
double difference(wall::Picture& picture, const std::vector<std::uint8_t>& full) {
  double sum = 0, count = 0;
  const render::TilePlan p = plan();
  for (const render::Tile& t : p.tiles) {
    if (t.kind != render::TileKind::kWall) continue;
    for (int y = t.y; y < t.y + t.height; ++y) {
      for (int x = 4 * t.x; x < 4 * (t.x + t.width); ++x) {
        const auto i = static_cast<std::size_t>(4 * y * p.frame_width + x);
        const double d = double{static_cast<double>(picture.pixels()[i])} - full[i];
        sum += x % 4 == 3 ? 0 : d * d;
        count += x % 4 == 3 ? 0 : 1;
      }
    }
  }
  return std::sqrt(sum / count);
}

void save(wall::Picture& picture, const std::string& path) {
  const render::TilePlan p = plan();
  if (const auto saved = render::writePng(path, p.frame_width, p.frame_height, picture.pixels());
      !saved)
    fmt::print("  {}\n", saved.error().what);
}

void comparePictures(const Dendrogram& model, const std::string& prefix) {
  SystemClock clock;
  std::vector<std::uint8_t> full;
  double error[2] = {}, drawing[2] = {};
  const std::size_t level = model.levelFor(60'000);
  for (const bool view_dependent : {false, true}) {
    const auto picture = pictureOf(model, view_dependent, clock);
    if (!picture) return;
    if (full.empty()) {
      picture->draw(closeUp(), 0, Timestamp::max());
      full.assign(picture->pixels().begin(), picture->pixels().end());
      save(*picture, prefix + "-full.png");
    }
    std::vector<double> times;
    for (int i = 0; i < 7; ++i)
      times.push_back(1000 * toSeconds(picture->draw(closeUp(), level, Timestamp::max()).drawing));
    drawing[view_dependent] = median(times);
    error[view_dependent] = difference(*picture, full);
    save(*picture, prefix + (view_dependent ? "-view.png" : "-even.png"));
  }
  fmt::print(
      "  close-up over three tiles, {} triangles: pixel error {:.2f} of 255 spent evenly "
      "({:.1f} ms), {:.2f} where the tiles look ({:.1f} ms): {:.2f} of it\n",
      model.trianglesAt(level), error[0], drawing[0], error[1], drawing[1], error[1] / error[0]);
  fmt::print("  pictures: {0}-full.png, {0}-even.png, {0}-view.png\n", prefix);
}

// From a file that no cache holds to the first picture in memory.
void firstPicture(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  ::fsync(fd);
  ::posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
  ::close(fd);
  SystemClock clock;
  const auto then = Steady::now();
  const auto model = render::readMrm(path);
  if (!model) return;
  const double opened = msSince(then);
  const auto picture = pictureOf(*model, true, clock);
  if (!picture) return;
  const double made = msSince(then);
  picture->draw(closeUp(), model->levelFor(40'000), Timestamp::max());
  fmt::print(
      "  cold file to first picture: {:.0f} ms (opened and checked {:.0f}, on the GPU {:.0f})\n",
      msSince(then), opened, made);
}

int run(const std::string& hgt, const std::string& out, bool large) {
  fs::create_directories(out);
  render::prepareSoftwareGl(0);
  auto heights = readHeights(hgt);
  const bool real = !heights.empty();
  if (!real) {
    fmt::print("{}: no such tile; synthetic hills instead\n", hgt);
    heights = hills();
  }
  for (std::size_t times = 1; times <= (large ? 2U : 1U); ++times) {
    const std::string path = fmt::format("{}/{}{}.mrm", out, real ? "dem" : "hills", times);
    if (!makeModel(heights, times, path)) {
      fmt::print(stderr, "{}: cannot be made\n", path);
      return 1;
    }
    firstPicture(path);
    const auto model = render::readMrm(path);
    if (!model) {
      fmt::print(stderr, "{}\n", model.error().what);
      return 1;
    }
    fmt::print("{}: {} triangles\n", path, model->triangleCount());
    timeCuts(*model);
    comparePictures(*model, path.substr(0, path.size() - 4));
  }
  return 0;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  CLI::App app{
      "Cuts of large models beside a memcpy; pictures of a budget spent evenly and by view"};
  std::string hgt = "../shared/data/dem/N44W072.hgt", out = "build/bench/cut";
  bool small = false;
  app.add_option("--hgt", hgt, "An SRTM 3 tile")->capture_default_str();
  app.add_option("--out", out, "Where models and pictures go")->capture_default_str();
  app.add_flag("--small", small, "Without the model of 11.5 million triangles");
  CLI11_PARSE(app, argc, argv);
  return merlin::bench::run(hgt, out, !small);
}
