// ./dev bench hostile: reduces shapes with many triangles at one vertex or edge, as merlin mesh
// reduce does, in turns with a regular mesh of the same number of triangles, and compares the
// times.
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "render/mesh/non_manifold.h"
#include "render/reduce/reduce.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/support/hostile_shapes.h"

namespace merlin::bench {
namespace {

constexpr double kMostRatio = 10;  // limit of a shape's time relative to that of the regular mesh

struct Options {
  std::size_t triangles = 100'000;
  int turns = 3;
};

// Returns the seconds of everything that a reduction does after it has read a mesh.
double secondsOf(const test::HostileShape& shape, std::size_t triangles) {
  render::mesh::Mesh mesh = shape.make(triangles);
  const auto began = std::chrono::steady_clock::now();
  splitNonManifold(mesh);
  ensureNormals(mesh);
  const auto reduced = render::reduce::reduce(mesh, {});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  if (!reduced) didNotRun(shape.name, reduced.error().what, "see hostile_shapes_test");
  if (reduced->report.collapses == 0)
    didNotRun(shape.name, "nothing was collapsed", "give more --triangles");
  return took.count();
}

bool run(const Options& options, Report& report) {
  // the first shape is the regular one
  const std::vector<test::HostileShape> shapes = test::hostileShapes();
  std::vector<std::vector<double>> seconds(shapes.size());
  for (int turn = 0; turn < options.turns; ++turn) {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      note(shapes[i].name);
      seconds[i].push_back(secondsOf(shapes[i], options.triangles));
    }
  }
  const Measured regular = medianOf(seconds[0], "reductions of the regular mesh");
  report.text("{} triangles, median of {} turns\n", options.triangles, options.turns);
  bool kept = true;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::string name = shapes[i].name;
    const Measured median = medianOf(seconds[i], "reductions of " + name);
    const Measured ratio = ratioOf(median, regular, name);
    report.text("{:12} {:8.3f} s, {:6.2f} of the regular mesh's\n", name, median.value(),
                ratio.value());
    report.figure(name, median, "s");
    report.figure(name + ".to_regular", ratio, "1");
    kept = kept && ratio.value() <= kMostRatio;
  }
  report.text("the limit is {:.0f}: {}\n", kMostRatio, kept ? "kept" : "MISSED");
  return kept;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app{
      "Reduces hostile shapes and, for comparison, a regular mesh of the same size"};
  merlin::bench::Options options;
  app.option("--triangles", options.triangles, "Number of triangles of each shape").showDefault();
  app.option("--turns", options.turns, "Number of turns; each reduces all shapes").showDefault();
  return app.run("hostile", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::run(options, report);
  });
}
