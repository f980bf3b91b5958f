// ./dev bench range: reads a range image of 1024 x 1024 pixels with colours, filters, triangulates
// and writes it as binary PLY, and compares this with only reading and writing the same bytes. Both
// use the same file system with warm caches. Fails if MERLIN takes more than five times as long.
//
// The image is synthetic: a wavy surface with noise, spikes and pixels without a return.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/blocks.h"
#include "daemon/base/files.h"
#include "daemon/base/random.h"
#include "render/mesh/io/mesh_file.h"
#include "render/range/filters.h"
#include "render/range/geometry.h"
#include "render/range/io/plane_file.h"
#include "render/range/io/range_file.h"
#include "render/range/triangulate.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/support/process.h"

namespace merlin::bench {
namespace {

namespace range = render::range;
using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kSide = 1024;
constexpr double kMostTimes = 5;

struct Files {
  std::string range, colour, mesh, copy, cloud;
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

// Seconds of each step, one value for each round.
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

// Writes the same image as the organised cloud that peers read: binary PCD.
void writeCloud(const Files& files) {
  const auto image = orEnd(range::readRange(files.range, {}), files.range).image;
  const std::vector<float> points = range::pointsOf(image, range::Work{threadsOr(0)});
  const auto colours = orEnd(FileCopy::read(files.colour), files.colour);
  const std::string_view rgb = colours.text().substr(colours.text().size() - 3 * kSide * kSide);
  std::string bytes = fmt::format(
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n"
      "WIDTH {0}\nHEIGHT {0}\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {1}\nDATA binary\n",
      kSide, kSide * kSide);
  const auto append = [&](const auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (std::size_t p = 0; p < kSide * kSide; ++p) {
    const bool there = image.range[p] != range::kNoReturn;
    for (std::size_t i = 0; i < 3; ++i)
      append(there ? points[3 * p + i] : std::numeric_limits<float>::quiet_NaN());
    const auto channel = [&](std::size_t c) {
      return std::uint32_t{static_cast<unsigned char>(rgb[3 * p + c])};
    };
    append(channel(0) << 16 | channel(1) << 8 | channel(2));
  }
  orEnd(writeFile(files.cloud, bytes), files.cloud);
}

// Runs a peer's program, which makes a mesh of triangles from the same image as a cloud, and
// compares its times.
void comparePeer(const std::string& program, int rounds, const Files& files, const Measured& all,
                 Report& report) {
  writeCloud(files);
  const auto image = orEnd(range::readRange(files.range, {}), files.range).image;
  // ten steps between pixels, at the mean range of 2 m
  const double edge_m = 10 * range::stepOf(image) * 2;
  const test::Outcome said = test::run(
      {program, files.cloud, files.mesh, fmt::format("{:.6f}", edge_m), std::to_string(rounds)});
  const auto object = nlohmann::json::parse(said.output, nullptr, false);
  if (said.status != 0 || !object.is_object())
    didNotRun(program, fmt::format("exit status {}; {}", said.status, said.output),
              "./dev bench range --peer builds it");
  const auto ms = [&](const char* step) { return object[step].get<double>(); };
  report.text(
      "PCL's organised mesh, with a median filter, without a filter for spikes and without "
      "normals: {} triangles\n",
      object["triangles"].get<std::uint64_t>());
  for (const char* step : {"reading", "filtering", "meshing", "writing", "all"})
    report.text("  {:<12} {:8.1f} ms\n", step, ms(step));
  const Measured peer =
      Measured::of(ms("all"), static_cast<std::uint64_t>(rounds), "imports by PCL");
  const Measured ratio = ratioOf(peer, scaled(all, 1000), "PCL beside MERLIN");
  report.text("  {:.1f} times MERLIN's time\n", ratio.value());
  report.figure("pcl_all_ms", peer, "ms");
  report.figure("pcl_by_merlin", ratio, "1");
}

bool measure(int rounds, const std::string& folder, const std::string& peer, Report& report) {
  std::filesystem::create_directories(folder);
  const Files files{folder + "/range.pgm", folder + "/colour.ppm", folder + "/mesh.ply",
                    folder + "/copy.ply", folder + "/cloud.pcd"};
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
  report.text("  {:.2f} times as long as the bytes alone; the limit is {}\n", ratio.value(),
              kMostTimes);
  report.figure("times_the_bytes_alone", ratio, "1");
  report.figure("triangles", Measured::of(static_cast<double>(steps.triangles), 1, "triangles"),
                "1");
  if (!peer.empty()) comparePeer(peer, rounds, files, all, report);
  return ratio.value() <= kMostTimes;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app(
      "From a range image to two million triangles, compared with reading and writing the bytes "
      "alone");
  int rounds = 15;
  std::string work = "build/bench/range", peer;
  app.option("--rounds", rounds, "Number of imports, and of copies of the bytes").range(1, 1000);
  app.option("--work", work, "Folder for the files").showDefault();
  app.option("--peer-program", peer,
             "Program with the same steps by PCL; ./dev bench range --peer builds it");
  return app.run("range", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::measure(rounds, work, peer, report);
  });
}
