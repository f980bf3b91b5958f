// ./dev bench rates: triangles that the wall draws in a second, compared with the table of 1998
// ([GOURLEY98] 2.5). Also the share of the time in which it draws (a loop that only drew and read
// back would be faster by no more than the rest), and the gain from a second context on a second
// core.
//
// As in 1998, the triangles are textured and at full resolution, before reduction, and the
// operator's view is a fourth one. The models are made of two copies of the demo's scan side by
// side, with a synthetic texture of 1024 x 1024 pixels. For each row of the table they are reduced
// to its number of triangles and drawn whole.
#include <cmath>
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "render/image/image_file.h"
#include "render/image/png_writer.h"
#include "render/mesh/io/mesh_file.h"
#include "render/reduce/reduce.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/support/model_frames.h"

namespace merlin::bench {
namespace {

constexpr double kRadius_m = 1.5;
constexpr int kPoses = 24;

struct Row1998 {
  std::size_t triangles;
  double rate_hz;
};
constexpr Row1998 kRows1998[] = {{16'000, 4}, {30'000, 2}, {63'000, 1.25}, {102'000, 0.7}};

render::mesh::Mesh twice(const render::mesh::Mesh& mesh) {
  const render::mesh::Box box = render::mesh::boundingBox(mesh.positions);
  const float step = 1.1F * (box.high[0] - box.low[0]);
  render::mesh::Mesh both = mesh;
  const auto vertices = static_cast<std::uint32_t>(mesh.vertexCount());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    both.positions.push_back(mesh.positions[i] + (i % 3 == 0 ? step : 0));
  for (const std::uint32_t v : mesh.triangles) both.triangles.push_back(v + vertices);
  for (render::mesh::Feature& f : both.features) {
    const std::vector<float> values = f.values;
    f.values.insert(f.values.end(), values.begin(), values.end());
  }
  return both;
}

// Adds texture coordinates around the mesh's long axis, and a chequered texture with noise.
Result<Ok> dress(render::mesh::Mesh& mesh) {
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
  if (auto written = render::image::writePng(path, kSide, kSide, rgba); !written) return written;
  auto picture = render::image::readImage(path);
  std::filesystem::remove(path);
  if (!picture) return picture.error();
  mesh.texture = std::move(picture->file);
  const render::mesh::Box box = render::mesh::boundingBox(mesh.positions);
  render::mesh::Feature texcoord{"texcoord", 2, {}};
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

// Returns the pose of the model in front of the viewer, turned a little further at each step.
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

// Measures one frame. Only the steps that draw and read back count as drawing, not the cut, the
// upload and the time between the steps.
Times timeOf(render::frame::FrameRenderer& renderer, const Eigen::Isometry3f& T_eye_model,
             std::size_t level, const Clock& clock) {
  const Timestamp began = clock.now();
  renderer.draw({.T_eye_content = T_eye_model, .step = level});
  Times times{toSeconds(clock.now() - began), 0};
  for (const render::frame::FrameStep& step : renderer.steps()) {
    using Kind = render::frame::FrameStep::Kind;
    if (step.kind == Kind::kDraw || step.kind == Kind::kReadBack)
      times.drawing_s += toSeconds(step.end - step.begin);
  }
  return times;
}

class Rate {
 public:
  void add(const Times& t) {
    frame_s_.push_back(t.frame_s);
    share_.push_back(t.drawing_s / t.frame_s);
  }
  Measured hz() const {
    const Measured frame_s = medianOf(frame_s_, "frames");
    return Measured::of(1 / frame_s, frame_s.count(), "frames");
  }
  // Returns the median share; throws DidNotRun if nothing was drawn.
  Measured drawingShare() const {
    const Measured share = medianOf(share_, "frames");
    if (share <= 0)
      didNotRun("drawing", "no step of a frame drew or read back", "see the renderer");
    return share;
  }

 private:
  std::vector<double> frame_s_, share_;
};

// Draws with one and with two contexts in turns, pose by pose. Returns whether one context reaches
// each rate of 1998.
bool bench(const render::lod::Dendrogram& model, render::frame::FrameRenderer& one,
           render::frame::FrameRenderer& two, Report& report) {
  const SystemClock clock;
  report.text(
      "triangles   1998, Hz   one context, Hz   times   triangles/s   drawing's share   two, Hz   "
      "of one's\n");
  bool reached = true;
  for (const Row1998& row : kRows1998) {
    const std::size_t level = model.levelFor(row.triangles), drawn = model.trianglesAt(level);
    Rate by_one, by_two;
    for (render::frame::FrameRenderer* renderer : {&one, &two})
      timeOf(*renderer, pose(0), level, clock);
    for (int k = 0; k < kPoses; ++k) {
      by_one.add(timeOf(one, pose(k), level, clock));
      by_two.add(timeOf(two, pose(k), level, clock));
    }
    const Measured hz = by_one.hz(), two_hz = by_two.hz(), share = by_one.drawingShare();
    report.text("{:9} {:10.2f} {:17.1f} {:7.0f} {:13.0f} {:17.2f} {:9.1f} {:10.2f}\n", drawn,
                row.rate_hz, hz.value(), hz / row.rate_hz, hz * static_cast<double>(row.triangles),
                share.value(), two_hz.value(), two_hz / hz);
    const std::string name = fmt::format("{}.", row.triangles);
    report.figure(name + "one_context", hz, "Hz");
    report.figure(name + "two_contexts", two_hz, "Hz");
    report.figure(name + "by_1998", scaled(hz, 1 / row.rate_hz), "1");
    report.figure(name + "drawing_share", share, "1");
    reached = reached && hz.value() >= row.rate_hz;
  }
  return reached;
}

struct Options {
  std::string scan = MERLIN_SOURCE_DIR "/config/models/ankylosaurus.ply";
  int raster_threads = 0;
  bool textured = true;
};

// Returns the value, or ends the benchmark if there is an error.
template <typename T>
T expect(Result<T> result, const char* subject) {
  if (!result) didNotRun(subject, result.error().what, "see --scan");
  return *std::move(result);
}

render::lod::Dendrogram makeModel(const Options& options) {
  render::mesh::Mesh mesh = twice(expect(render::mesh::readMesh(options.scan), "the scan").mesh);
  if (options.textured) expect(dress(mesh), "the texture");
  render::mesh::ensureNormals(mesh);
  const auto reduced = expect(render::reduce::reduce(mesh, {}), "the reduction");
  return render::lod::buildDendrogram(mesh, reduced.log);
}

bool run(const Options& options, Report& report) {
  render::gl::prepareSoftwareGl(options.raster_threads);
  const render::lod::Dendrogram model = makeModel(options);
  // With fewer triangles, the measured rate would be that of another model.
  if (model.triangleCount() < kRows1998[std::size(kRows1998) - 1].triangles) {
    didNotRun("the scan",
              fmt::format("twice {} has {} triangles", options.scan, model.triangleCount()),
              "the scan needs at least 51,000 triangles");
  }
  const auto plan = render::tiles::planTiles({});
  const SystemClock clock;
  const auto renderer = [&](int contexts) {
    return expect(test::rendererOf(model, *plan, {.gl = {.contexts = contexts}, .model = {}},
                                   kRadius_m, clock),
                  "the renderer");
  };
  const auto one = renderer(1), two = renderer(2);
  report.figure("renderer", one->contexts()->renderer(), 1);
  report.text("{}, {} raster threads; three tiles and the operator's view, 640 x 480 each; {}\n",
              one->contexts()->renderer(), options.raster_threads,
              options.textured ? "textured" : "coloured");
  return bench(model, *one, *two, report);
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::Options options;
  merlin::bench::CommandLine app("Rates at full resolution, compared with those of 1998.");
  app.option("--scan", options.scan, "A scan with colours").showDefault();
  app.option("--raster-threads", options.raster_threads,
             "Number of threads of Mesa's software renderer")
      .range(0, 16);
  app.flag("!--coloured", options.textured, "Colours at the vertices instead of a texture");
  return app.run("rates", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::run(options, report);
  });
}
