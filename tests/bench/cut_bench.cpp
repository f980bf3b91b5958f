// ./dev bench cut: cuts of a large model with any number of triangles. Measures the time of a cut
// compared with a memcpy of its result, the memory, the time to the first picture from a file that
// is not cached, and how much the picture improves if triangles are spent where the tiles look,
// also with tiles that have their own cameras.
//
// The model is made from --hgt FILE, an elevation tile of 1201 x 1201 big-endian heights (SRTM 3):
// as it is (2.9 million triangles), or mirrored 2 x 2 (11.5 million; to that extent synthetic). It
// is reduced once and kept under --out. Without the file, the model is synthetic hills of the same
// size.
#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "render/image/png_writer.h"
#include "render/lod/io/mrm_file.h"
#include "render/reduce/reduce.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/support/model_frames.h"

namespace merlin::bench {
namespace {

namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;
using render::lod::Clusters;
using render::lod::Dendrogram;
using render::mesh::Mesh;

constexpr std::size_t kSide = 1201;

double msSince(Steady::time_point then) {
  return std::chrono::duration<double, std::milli>(Steady::now() - then).count();
}

// Returns the heights in metres, row by row; empty if there is no such file.
std::vector<float> readHeights(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<unsigned char> bytes(2 * kSide * kSide);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
    return {};
  std::vector<float> heights;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const auto raw = static_cast<std::int16_t>(bytes[i] << 8 | bytes[i + 1]);
    heights.push_back(raw == -32768 ? 0 : raw);  // -32768 means no data
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

// Returns a mesh of the heights, mirrored `times` x `times`. Samples are 66 m by 92.6 m apart (at
// 44 degrees north).
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
  render::mesh::ensureNormals(mesh);
  return mesh;
}

// Returns the value, or ends the benchmark if there is an error.
template <typename T>
T expect(Result<T> result, const std::string& subject) {
  if (!result) didNotRun(subject, result.error().what, "--out names the folder of the models");
  return *std::move(result);
}

void makeModel(const std::vector<float>& heights, std::size_t times, const std::string& path) {
  if (fs::exists(path)) return;
  note(fmt::format("making {} ...", path));
  const Mesh mesh = heightField(heights, times);
  const auto reduced = expect(render::reduce::reduce(mesh, {}), path);
  expect(render::lod::writeMrm(path, render::lod::buildDendrogram(mesh, reduced.log)), path);
}

// --- cuts ----------------------------------------------------------------------------------------

// Makes cuts for budgets in random order, and compares each with a memcpy of its result.
void timeCuts(const Dendrogram& model, const std::string& name, Report& report) {
  const auto began = Steady::now();
  const Clusters clusters(model, {});
  report.text(
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
    if (n == 0) didNotRun("the cut", "it returned no triangle", "see render/lod");
    cut[b].push_back(msSince(then));
    then = Steady::now();
    std::memcpy(copied.data(), out.data(), 12 * n);
    copy[b].push_back(msSince(then));
  }
  report.text("  {:>9} {:>10} {:>10} {:>7}   {}\n", "triangles", "cut ms", "memcpy ms", "ratio",
              "from the leaves, ms");
  for (std::size_t b = 0; b < budgets.size(); ++b) {
    const Measured ms = medianOf(cut[b], "cuts");
    const Measured ratio = ratioOf(ms, medianOf(copy[b], "copies"), "cuts");
    report.text("  {:>9} {:>10.3f} {:>10.3f} {:>7.1f}   {:.3f}\n", budgets[b], ms.value(),
                medianOf(copy[b], "copies").value(), ratio.value(),
                medianOf(plain[b], "cuts from the leaves").value());
    report.figure(fmt::format("{}.{}.cut", name, budgets[b]), ms, "ms");
    report.figure(fmt::format("{}.{}.by_memcpy", name, budgets[b]), ratio, "1");
  }
}

// --- pictures ------------------------------------------------------------------------------------

// Returns a plan of three tiles that touch each other and the operator's tile, 640 x 480 pixels
// each.
render::tiles::TilePlan plan() {
  auto made = render::tiles::planTiles({});
  return *std::move(made);
}

// Returns a view from low over the middle of the field along the ground.
Eigen::Isometry3f closeUp() {
  Eigen::Isometry3f view = Eigen::Isometry3f::Identity();
  view.translate(Eigen::Vector3f(0.1F, -0.08F, 0.25F));
  view.rotate(Eigen::AngleAxisf(-1.3F, Eigen::Vector3f::UnitX()));
  view.rotate(Eigen::AngleAxisf(0.4F, Eigen::Vector3f::UnitZ()));
  return view;
}

std::unique_ptr<render::frame::FrameRenderer> rendererOf(const Dendrogram& model,
                                                         bool view_dependent, const Clock& clock) {
  static const render::tiles::TilePlan kPlan = plan();
  render::frame::RenderSettings settings;
  settings.model.view_dependent = view_dependent;
  auto made = test::rendererOf(model, kPlan, settings, 1.5, clock);
  if (!made) didNotRun("the renderer", made.error().what, "see EGL");
  return *std::move(made);
}

// Returns the root mean square difference, 0..255, over the wall's tiles.
double difference(render::frame::FrameRenderer& renderer, const std::vector<std::uint8_t>& full) {
  double sum = 0, count = 0;
  const render::tiles::TilePlan p = plan();
  for (const render::tiles::Tile& t : p.tiles) {
    if (t.kind != render::tiles::TileKind::kWall) continue;
    for (int y = t.y; y < t.y + t.height; ++y) {
      for (int x = 4 * t.x; x < 4 * (t.x + t.width); ++x) {
        const auto i = static_cast<std::size_t>(4 * y * p.frame_width + x);
        const double d = double{static_cast<double>(renderer.pixels()[i])} - full[i];
        sum += x % 4 == 3 ? 0 : d * d;
        count += x % 4 == 3 ? 0 : 1;
      }
    }
  }
  return std::sqrt(sum / count);
}

void save(render::frame::FrameRenderer& renderer, const std::string& path) {
  const render::tiles::TilePlan p = plan();
  expect(render::image::writePng(path, p.frame_width, p.frame_height, renderer.pixels()), path);
}

void comparePictures(const Dendrogram& model, const std::string& prefix, const std::string& name,
                     Report& report) {
  SystemClock clock;
  std::vector<std::uint8_t> full;
  double error[2] = {}, drawing[2] = {};
  const std::size_t level = model.levelFor(60'000);
  for (const bool view_dependent : {false, true}) {
    const auto renderer = rendererOf(model, view_dependent, clock);
    if (full.empty()) {
      renderer->draw({.T_eye_content = closeUp(), .step = 0});
      full.assign(renderer->pixels().begin(), renderer->pixels().end());
      save(*renderer, prefix + "-full.png");
    }
    std::vector<double> times;
    for (int i = 0; i < 7; ++i)
      times.push_back(
          1000 * toSeconds(renderer->draw({.T_eye_content = closeUp(), .step = level}).drawing));
    drawing[view_dependent] = medianOf(times, "frames");
    error[view_dependent] = difference(*renderer, full);
    save(*renderer, prefix + (view_dependent ? "-view.png" : "-even.png"));
  }
  const auto frames = [](double value) { return Measured::of(value, 1, "pictures"); };
  const Measured ratio = ratioOf(frames(error[1]), frames(error[0]), "pictures");
  report.text(
      "  close-up over three tiles, {} triangles: pixel error {:.2f} of 255 spent evenly "
      "({:.1f} ms), {:.2f} where the tiles look ({:.1f} ms): {:.2f} of it\n",
      model.trianglesAt(level), error[0], drawing[0], error[1], drawing[1], ratio.value());
  report.figure(name + ".view_error_by_even", ratio, "1");
  report.text("  pictures: {0}-full.png, {0}-even.png, {0}-view.png\n", prefix);
}

// Tiles with their own cameras, beside the wall's three tiles. One cut for all tiles, in which each
// view requests what it would request alone, is compared with cuts of the same size for the wall
// alone and for each view alone.
struct ViewGroup {
  const char* name;
  std::vector<render::tiles::TileCamera> cameras;
};

render::tiles::TilePlan planOf(const std::vector<render::tiles::TileCamera>& cameras) {
  render::tiles::TilesSettings s;
  s.frame_width = 640 * static_cast<int>(cameras.size());
  s.frame_height = 480;
  s.tiles.clear();
  double turns = 1;
  for (const render::tiles::TileCamera camera : cameras) {
    const auto n = static_cast<int>(s.tiles.size());
    s.tiles.push_back({fmt::format("{}", n), render::tiles::TileKind::kWall, 640 * n, 0, 0});
    s.tiles.back().view = camera;
    if (camera == render::tiles::TileCamera::kWall) s.tiles.back().turns = turns--;
  }
  return expect(render::tiles::planTiles(s), "the plan");
}

struct DrawnViews {
  std::vector<double> error;  // for each tile: root mean square difference from full detail
  double drawing_ms = 0;
};

DrawnViews drawViews(const Dendrogram& model, const std::vector<render::tiles::TileCamera>& cameras,
                     std::size_t step) {
  const SystemClock clock;
  const render::tiles::TilePlan plan = planOf(cameras);
  const auto renderer = expect(test::rendererOf(model, plan, {}, 1.5, clock), "the renderer");
  renderer->draw({.T_eye_content = closeUp(), .step = 0});
  const std::vector<std::uint8_t> full(renderer->pixels().begin(), renderer->pixels().end());
  std::vector<double> times;
  for (int i = 0; i < 7; ++i)
    times.push_back(1000 *
                    toSeconds(renderer->draw({.T_eye_content = closeUp(), .step = step}).drawing));
  DrawnViews drawn{{}, medianOf(times, "frames").value()};
  std::vector<double> squares(cameras.size());
  for (std::size_t i = 0; i < full.size(); ++i) {
    const double d = static_cast<double>(renderer->pixels()[i]) - full[i];
    squares[i / 4 / 640 % cameras.size()] += i % 4 == 3 ? 0 : d * d;
  }
  for (const double sum : squares) drawn.error.push_back(std::sqrt(sum / (3.0 * 640 * 480)));
  return drawn;
}

void compareViews(const Dendrogram& model, const std::string& name, Report& report) {
  using Camera = render::tiles::TileCamera;
  const ViewGroup groups[] = {{"wall", {Camera::kWall, Camera::kWall, Camera::kWall}},
                              {"top", {Camera::kTop}},
                              {"side", {Camera::kSide}},
                              {"front", {Camera::kFront}}};
  std::vector<Camera> all;
  for (const ViewGroup& group : groups)
    all.insert(all.end(), group.cameras.begin(), group.cameras.end());
  const std::size_t step = model.levelFor(60'000);
  const DrawnViews together = drawViews(model, all, step);
  double alone_ms = 0;
  std::size_t tile = 0;
  report.text("  views of their own beside the wall, {} triangles: pixel error of 255\n",
              model.trianglesAt(step));
  for (const ViewGroup& group : groups) {
    const DrawnViews alone = drawViews(model, group.cameras, step);
    alone_ms += alone.drawing_ms;
    for (const double error : alone.error) {
      report.text("    {:<6} {:6.2f} with one cut for all, {:6.2f} with its own\n", group.name,
                  together.error[tile++], error);
    }
  }
  const Measured ratio = ratioOf(Measured::of(together.drawing_ms, 7, "frames"),
                                 Measured::of(alone_ms, 7, "frames"), "frames");
  report.text("    drawn in {:.1f} ms with one cut for all, {:.1f} ms with a cut for each\n",
              together.drawing_ms, alone_ms);
  report.figure(name + ".views_one_cut_by_each", ratio, "1");
}

// Measures the time from a file that is in no cache to the first picture in memory.
void firstPicture(const std::string& path, const std::string& name, Report& report) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  ::fsync(fd);
  ::posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
  ::close(fd);
  SystemClock clock;
  const auto then = Steady::now();
  const auto model = expect(render::lod::readMrm(path), "the model");
  const double opened = msSince(then);
  const auto renderer = rendererOf(model, true, clock);
  const double made = msSince(then);
  renderer->draw({.T_eye_content = closeUp(), .step = model.levelFor(40'000)});
  const auto all = Measured::of(msSince(then), 1, "first pictures");
  report.text(
      "  cold file to first picture: {:.0f} ms (opened and checked {:.0f}, on the GPU {:.0f})\n",
      all.value(), opened, made);
  report.figure(name + ".first_picture", all, "ms");
}

struct Options {
  std::string hgt;  // file; empty: the tile beside the repository or, without that, synthetic hills
  std::string out = "build/bench/cut";
  bool small = false;
};

constexpr const char* kTile = "../shared/data/dem/N44W072.hgt";

bool run(const Options& options, Report& report) {
  fs::create_directories(options.out);
  render::gl::prepareSoftwareGl(0);
  const std::string tile = options.hgt.empty() ? kTile : options.hgt;
  auto heights = readHeights(tile);
  const bool real = !heights.empty();
  if (!real && !options.hgt.empty())
    didNotRun("the model of " + options.hgt, "it is not a tile of 1201 x 1201 heights",
              "without --hgt the model is made of synthetic hills");
  if (!real) {
    report.text("{}: no such tile; using synthetic hills instead\n", kTile);
    heights = hills();
  }
  for (std::size_t times = 1; times <= (options.small ? 1U : 2U); ++times) {
    const std::string name =
        fmt::format("{}-{}x{}", real ? fs::path(tile).stem().string() : "hills", times, times);
    const std::string prefix = fmt::format("{}/{}", options.out, name), path = prefix + ".mrm";
    makeModel(heights, times, path);
    firstPicture(path, name, report);
    const auto model = expect(render::lod::readMrm(path), "the model");
    report.text("{}: {} triangles\n", path, model.triangleCount());
    note(name + ": cuts");
    timeCuts(model, name, report);
    comparePictures(model, prefix, name, report);
    compareViews(model, name, report);
  }
  return true;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app{
      "Cuts of large models compared with a memcpy; pictures of a budget spent evenly and by view"};
  merlin::bench::Options options;
  app.option("--hgt", options.hgt,
             "An SRTM 3 tile; the default is " + std::string(merlin::bench::kTile) +
                 " or, if that does not exist, synthetic hills");
  app.option("--out", options.out, "Folder for models and pictures").showDefault();
  app.flag("--small", options.small, "Leaves out the model of 11.5 million triangles");
  return app.run("cut", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::run(options, report);
  });
}
