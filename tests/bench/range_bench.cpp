// ./dev bench range: a range image of 1024 x 1024 pixels with colours, read, filtered, triangulated
// and written as binary PLY, beside reading and writing the same bytes alone, on the same file
// system, both warm. Fails above five times that.
//
// The image is synthetic: a wavy surface with noise, spikes and pixels without a return.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "daemon/base/blocks.h"
#include "daemon/base/files.h"
#include "daemon/base/random.h"
#include "render/mesh/io/mesh_file.h"
#include "render/range/filters.h"
#include "render/range/geometry.h"
#include "render/range/io/plane_file.h"
#include "render/range/io/range_file.h"
#include "render/range/triangulate.h"
#include "tests/bench/figures.h"

namespace merlin::bench {
namespace {

namespace range = render::range;
using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kSide = 1024;
constexpr double kMostTimes = 5;

struct Files {
  std::string range, colour, mesh, copy;
};

double secondsSince(SteadyClock::time_point then) {
  return std::chrono::duration<double>(SteadyClock::now() - then).count();
}

template <typename T>
T orEnd(Result<T> result, const std::string& subject) {
  if (!result) didNotRun(subject, result.error().what, "see --work");
  return *std::move(result);
}

void makeInput(const Files& files) {
  Random random(1);
  range::RangeImage image;
  image.width = image.height = kSide;
  image.geometry.horizontal_rad = image.geometry.vertical_rad = 1;
  std::string colours = fmt::format("P6\n{0} {0}\n255\n", kSide);
  for (std::size_t p = 0; p < kSide * kSide; ++p) {
    const double x = static_cast<double>(p % kSide), y = static_cast<double>(p / kSide);
    const double spike = p % 5003 == 0 ? 0.5 : 0;
    const double r = 2 + 0.1 * std::sin(x / 40) * std::cos(y / 50) + 2e-4 * random.normal() + spike;
    image.range.push_back(p % 9001 == 0 ? range::kNoReturn : static_cast<float>(r));
    for (const double c : {x / 4, y / 4, (x + y) / 8})
      colours.push_back(static_cast<char>(static_cast<unsigned char>(c)));
  }
  orEnd(range::writeRange(files.range, image), files.range);
  orEnd(writeFile(files.colour, colours), files.colour);
}

// Seconds of each step.
struct Steps {
  std::vector<double> reading{}, filtering{}, meshing{}, writing{}, all{}, alone{};
  std::uint64_t triangles = 0;
};

void importOnce(const Files& files, unsigned threads, Steps& steps) {
  const range::Work work{threads};
  const auto began = SteadyClock::now();
  auto lap = began;
  const auto step = [&](std::vector<double>& seconds) {
    seconds.push_back(secondsSince(lap));
    lap = SteadyClock::now();
  };
  auto loaded = orEnd(range::readRange(files.range, {}), files.range);
  range::RangeImage& image = loaded.image;
  image.planes.push_back(orEnd(range::readPlane("colour", files.colour, image), files.colour));
  step(steps.reading);
  range::Threshold spikes, edge;
  spikes.per_range = 0.02F;
  edge.per_range = static_cast<float>(10 * range::stepOf(image));
  range::removeSpikes(image, spikes, work);
  range::medianFilter(image, 3, work);
  step(steps.filtering);
  const auto mesh = range::triangulate(image, range::pointsOf(image, work), edge, work);
  step(steps.meshing);
  orEnd(render::mesh::writeMesh(files.mesh, mesh.mesh), files.mesh);
  step(steps.writing);
  steps.all.push_back(secondsSince(began));
  steps.triangles = mesh.mesh.triangleCount();
}

// Reads the same files and writes as many bytes as the mesh has.
void copyOnce(const Files& files, const std::string& mesh, Steps& steps) {
  const auto began = SteadyClock::now();
  const auto range = orEnd(FileCopy::read(files.range), files.range);
  const auto colour = orEnd(FileCopy::read(files.colour), files.colour);
  asm volatile("" : : "r"(range.bytes().data()), "r"(colour.bytes().data()) : "memory");
  orEnd(writeFile(files.copy, mesh), files.copy);
  steps.alone.push_back(secondsSince(began));
}

bool measure(int rounds, const std::string& folder, Report& report) {
  std::filesystem::create_directories(folder);
  const Files files{folder + "/range.pgm", folder + "/colour.ppm", folder + "/mesh.ply",
                    folder + "/copy.ply"};
  makeInput(files);
  const unsigned threads = threadsOr(0);
  Steps warm, steps;
  importOnce(files, threads, warm);
  const std::string mesh(orEnd(FileCopy::read(files.mesh), files.mesh).text());
  for (int round = 0; round < rounds; ++round) {
    copyOnce(files, mesh, steps);
    importOnce(files, threads, steps);
  }
  std::filesystem::remove(files.copy);
  const Measured all = medianOf(steps.all, "imports"), alone = medianOf(steps.alone, "copies");
  const Measured ratio = ratioOf(all, alone, "import beside reading and writing alone");
  report.text("{0} x {0} pixels with colour, {1} triangles, {2:.1f} MB of PLY, {3} processors\n",
              kSide, steps.triangles, static_cast<double>(mesh.size()) / 1e6, threads);
  const auto line = [&](const char* name, const std::vector<double>& seconds) {
    const Measured ms = scaled(medianOf(seconds, name), 1000);
    report.text("  {:<12} {:8.1f} ms\n", name, ms.value());
    report.figure(std::string(name) + "_ms", ms, "ms");
  };
  line("reading", steps.reading);
  line("filtering", steps.filtering);
  line("meshing", steps.meshing);
  line("writing", steps.writing);
  line("all", steps.all);
  line("bytes_alone", steps.alone);
  report.text("  {:.2f} times the bytes alone; allowed are {}\n", ratio.value(), kMostTimes);
  report.figure("times_the_bytes_alone", ratio, "1");
  report.figure("triangles", Measured::of(static_cast<double>(steps.triangles), 1, "triangles"),
                "1");
  return ratio.value() <= kMostTimes;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  CLI::App app("A range image to two million triangles, beside its bytes alone");
  int rounds = 15;
  bool json = false;
  std::string work = "build/bench/range";
  app.add_option("--rounds", rounds, "Imports, and copies of the bytes")
      ->check(CLI::Range(1, 1000));
  app.add_option("--work", work, "Folder for its files")->capture_default_str();
  app.add_flag("--json", json, "One JSON object");
  CLI11_PARSE(app, argc, argv);
  return merlin::bench::runBench("range", json, [&](merlin::bench::Report& report) {
    return merlin::bench::measure(rounds, work, report);
  });
}
