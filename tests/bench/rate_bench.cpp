// ./dev bench rates: what the wall draws in a second, beside the table of 1998 (row W10), and which
// share of it is drawing: a loop that only drew and read back could not be faster by more than
// that; and what a second context on a second core is worth.
//
// W10: textured triangles at full resolution, before reduction; the operator's view is a fourth
// one, as there. Each is the whole model, two copies of the demo's scan side by side in a made-up
// picture of 1024 x 1024, reduced to that many triangles and drawn whole.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "daemon/wall/picture.h"
#include "render/mesh/io/mesh_file.h"
#include "render/mesh/io/picture_file.h"
#include "render/out/png.h"
#include "render/reduce/reduce.h"
#include "tests/support/statistics.h"

namespace merlin::bench {
namespace {

using test::median;
using wall::Picture;

constexpr double kRadius_m = 1.5;
constexpr int kPoses = 24;

struct Row1998 {
  std::size_t triangles;
  double rate_hz;
};
constexpr Row1998 kRows1998[] = {{16'000, 4}, {30'000, 2}, {63'000, 1.25}, {102'000, 0.7}};

render::Mesh twice(const render::Mesh& mesh) {
  const render::Box box = render::boundingBox(mesh.positions);
  const float step = 1.1F * (box.high[0] - box.low[0]);
  render::Mesh both = mesh;
  const auto vertices = static_cast<std::uint32_t>(mesh.vertexCount());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    both.positions.push_back(mesh.positions[i] + (i % 3 == 0 ? step : 0));
  for (const std::uint32_t v : mesh.triangles) both.triangles.push_back(v + vertices);
  for (render::Feature& f : both.features) {
    const std::vector<float> values = f.values;
    f.values.insert(f.values.end(), values.begin(), values.end());
  }
  return both;
}

// Round its long axis; a chequered picture with noise.
Result<Ok> dress(render::Mesh& mesh) {
  constexpr int kSide = 1024;
  std::vector<std::uint8_t> rgba;
  std::uint32_t noise = 1;
  for (int i = 0; i < kSide * kSide; ++i) {
    noise = 1664525 * noise + 1013904223;
    const bool dark = (i / 32 + i / kSide / 32) % 2 == 0;
    const auto grey = static_cast<std::uint8_t>((dark ? 90 : 170) + (noise >> 26));
    rgba.insert(rgba.end(), {grey, grey, static_cast<std::uint8_t>(grey / 2), 255});
  }
  const std::string path = std::filesystem::temp_directory_path() / "merlin_rates.png";
  if (auto written = render::writePng(path, kSide, kSide, rgba); !written) return written;
  auto picture = render::readPicture(path);
  std::filesystem::remove(path);
  if (!picture) return picture.error();
  mesh.texture = std::move(picture->file);
  const render::Box box = render::boundingBox(mesh.positions);
  render::Feature texcoord{"texcoord", 2, {}};
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const float* p = &mesh.positions[3 * v];
    const float y = p[1] - (box.low[1] + box.high[1]) / 2,
                z = p[2] - (box.low[2] + box.high[2]) / 2;
    texcoord.values.push_back(0.5F + std::atan2(z, y) / 6.2832F);
    texcoord.values.push_back((p[0] - box.low[0]) / (box.high[0] - box.low[0]));
  }
  mesh.features.push_back(std::move(texcoord));
  return Ok{};
}

// In front of the viewer, turned a little further each time.
Eigen::Isometry3f pose(int k) {
  Eigen::Isometry3f view = Eigen::Isometry3f::Identity();
  view.translate(Eigen::Vector3f(0, 0, -2.05F));
  view.rotate(
      Eigen::AngleAxisf(static_cast<float>(k) * 6.2832F / kPoses, Eigen::Vector3f::UnitY()));
  view.rotate(Eigen::AngleAxisf(-1.5708F, Eigen::Vector3f::UnitX()));
  return view;
}

struct Times {
  double frame_s = 0, drawing_s = 0;
};

// Drawing are the steps that draw and read back: cut, upload and all between are not.
Times timeOf(Picture& picture, const Eigen::Isometry3f& T_eye_model, std::size_t level,
             const Clock& clock) {
  const Timestamp began = clock.now();
  picture.draw(T_eye_model, level, Timestamp::max());
  Times times{toSeconds(clock.now() - began), 0};
  for (const wall::PaintStep& step : picture.steps()) {
    if (step.kind == shm::StepKind::kDraw || step.kind == shm::StepKind::kReadBack)
      times.drawing_s += toSeconds(step.end - step.begin);
  }
  return times;
}

struct Measured {
  std::vector<double> frame_s, share;

  void add(const Times& t) {
    frame_s.push_back(t.frame_s);
    share.push_back(t.drawing_s / t.frame_s);
  }
  double hz() const { return 1 / median(frame_s); }
};

// In turns, pose by pose.
void bench(const render::Dendrogram& model, Picture& one, Picture& two, const Clock& clock) {
  fmt::print(
      "triangles   1998, Hz   one context, Hz   times   triangles/s   drawing's share   two, Hz   "
      "of one's\n");
  for (const Row1998& row : kRows1998) {
    const std::size_t level = model.levelFor(row.triangles);
    Measured by_one, by_two;
    for (Picture* picture : {&one, &two}) timeOf(*picture, pose(0), level, clock);
    for (int k = 0; k < kPoses; ++k) {
      by_one.add(timeOf(one, pose(k), level, clock));
      by_two.add(timeOf(two, pose(k), level, clock));
    }
    fmt::print("{:9} {:10.2f} {:17.1f} {:7.0f} {:13.0f} {:17.2f} {:9.1f} {:10.2f}\n",
               model.trianglesAt(level), row.rate_hz, by_one.hz(), by_one.hz() / row.rate_hz,
               by_one.hz() * static_cast<double>(row.triangles), median(by_one.share), by_two.hz(),
               by_two.hz() / by_one.hz());
  }
}

int run(const std::string& scan, int raster_threads, bool textured) {
  render::prepareSoftwareGl(raster_threads);
  auto loaded = render::readMesh(scan);
  if (!loaded) {
    fmt::print(stderr, "{}\n", loaded.error().what);
    return 1;
  }
  render::Mesh mesh = twice(loaded->mesh);
  if (textured) {
    if (const auto dressed = dress(mesh); !dressed) {
      fmt::print(stderr, "{}\n", dressed.error().what);
      return 1;
    }
  }
  render::ensureNormals(mesh);
  const auto reduced = render::reduce(mesh, {});
  if (!reduced) return 1;
  const render::Dendrogram model = render::buildDendrogram(mesh, reduced->log);
  const auto plan = render::planTiles({});
  const SystemClock clock;
  const auto one = Picture::make(model, *plan, {.contexts = 1, .look = {}}, kRadius_m, clock);
  const auto two = Picture::make(model, *plan, {.contexts = 2, .look = {}}, kRadius_m, clock);
  for (const auto* picture : {&one, &two}) {
    if (*picture) continue;
    fmt::print(stderr, "{}\n", picture->error().what);
    return 1;
  }
  fmt::print("{}, {} raster threads; three tiles and the operator's view, 640 x 480 each; {}\n",
             (*one)->contexts()->renderer(), raster_threads, textured ? "textured" : "coloured");
  bench(model, **one, **two, clock);
  return 0;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  std::string scan = MERLIN_SOURCE_DIR "/config/models/ankylosaurus.ply";
  int raster_threads = 0;
  bool textured = true;
  CLI::App app("Rates at full resolution, beside those of 1998.");
  app.add_option("--scan", scan, "A scan with colours")->capture_default_str();
  app.add_option("--raster-threads", raster_threads, "Of Mesa's software renderer")
      ->check(CLI::Range(0, 16));
  app.add_flag("!--coloured", textured, "Colours at the vertices instead of a texture");
  CLI11_PARSE(app, argc, argv);
  return merlin::bench::run(scan, raster_threads, textured);
}
