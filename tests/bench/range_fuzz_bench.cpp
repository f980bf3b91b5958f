// ./dev bench fuzz-ranges: gives damaged range files and point clouds of every kind to MERLIN's own
// readers; ranges that are read also go through the filters and the triangulation. Each input has
// to end with a valid mesh, a valid cloud, or one sentence that names the file. The program is
// built with the sanitizers.
//
// The files are synthetic and small. Each gets one to four changes: bytes or digits are changed,
// pieces are removed or doubled, numbers are made too large.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "daemon/base/bytes.h"
#include "daemon/base/printable_text.h"
#include "daemon/base/random.h"
#include "daemon/base/unique_fd.h"
#include "render/points/io/cloud_file.h"
#include "render/range/filters.h"
#include "render/range/geometry.h"
#include "render/range/io/angle_table.h"
#include "render/range/io/plane_file.h"
#include "render/range/io/range_file.h"
#include "render/range/triangulate.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/support/clouds.h"

namespace merlin::bench {
namespace {

namespace range = render::range;

std::string pcdOf(const std::string& form, const std::string& points) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb label\nSIZE 4 4 4 4 2\nTYPE F F F U U\nCOUNT "
         "1 1 "
         "1 1 1\nWIDTH 3\nHEIGHT 2\nVIEWPOINT 0 0 9 1 0 0 0\nPOINTS 6\nDATA " +
         form + "\n" + points;
}

std::string pcdPoints() {
  std::string bytes;
  for (int p = 0; p < 6; ++p) {
    for (const int k : {p % 3, -p / 3, p % 2}) appendLeFloat(bytes, static_cast<float>(k));
    appendLe32(bytes, 0x102030U * static_cast<std::uint32_t>(p));
    bytes += "\1\2";
  }
  return bytes;
}

// Compresses to literal runs only. For a file that is ordered by fields, the bytes would be the
// same in another order.
std::string packed(const std::string& bytes) {
  std::string runs;
  for (std::size_t at = 0; at < bytes.size(); at += 32) {
    const std::string run = bytes.substr(at, 32);
    runs.push_back(static_cast<char>(run.size() - 1));
    runs += run;
  }
  std::string text;
  appendLe32(text, static_cast<std::uint32_t>(runs.size()));
  appendLe32(text, static_cast<std::uint32_t>(bytes.size()));
  return text + runs;
}

std::string pgmOf(const std::string& keys) {
  std::string bytes = "P5\n" + keys + "5 4\n65535\n";
  for (int p = 0; p < 20; ++p) appendBe16(bytes, static_cast<std::uint16_t>(p % 7 * 300));
  return bytes;
}

std::string gridOf(const std::string& form, const std::string& body) {
  return "ply\nformat " + form +
         " 1.0\nobj_info num_cols 3\nobj_info num_rows 2\nelement vertex 5\nproperty float x\n"
         "property float y\nproperty float z\nproperty uchar red\nelement range_grid 6\n"
         "property list uchar int vertex_indices\nend_header\n" +
         body;
}

std::string gridPoints() {
  std::string bytes;
  for (int v = 0; v < 5; ++v) {
    for (const int k : {v % 3, v / 3, v % 2}) appendLeFloat(bytes, static_cast<float>(k));
    bytes.push_back(static_cast<char>(50 * v));
  }
  for (std::uint32_t p = 0; p < 6; ++p) {
    bytes.push_back(p == 5 ? '\0' : '\1');
    if (p < 5) appendLe32(bytes, p);
  }
  return bytes;
}

// Returns a file in the format that merlin-import writes.
std::string importedGrid() {
  std::string bytes =
      "MERLIN grid 1\nsize: 3 2\nformat: FITS\ngeometry: elevation\ncell: 0.5 0.25\nprojection: "
      "WGS 84\norigin: 20 60\nlatitude: 60\nnote: a\nvalues\n";
  for (const float height : {1.0F, 2.0F, 3.0F, 1e9F, -9.0F, 0.5F}) appendLeFloat(bytes, height);
  return bytes;
}

std::vector<std::string> goodFiles() {
  return {
      pgmOf("# geometry: orthogonal\n# angles: 60 40\n# scale: 0.001\n# unit: m\n"),
      pgmOf("# geometry: spinning\n# angles: 360\n# beam: 10 1\n# beam: 5 -1\n# beam: 0\n# beam: "
            "-5 2\n# minimum: 1\n# maximum: 9\n"),
      pgmOf("# geometry: pinhole\n# angles: 60 40\n# feature: heat=a.pgm\n# camera: 1 0 0 5 0 1 0 "
            "6 0 0 1 7\n"),
      pgmOf("# geometry: elevation\n# cell: 30 20\n# no-return: 300\n"),
      "P2\n# angles: 9 9\n3 3 99\n1 2 3 4 5 6 7 8 9\n",
      "P6\n3 2\n255\n123456789012345678",
      pcdOf("binary", pcdPoints()),
      pcdOf("binary_compressed", packed(pcdPoints())),
      pcdOf("ascii", "0 0 0 1 2\n1 0 0 3 4\n2 0 1 5 6\n0 -1 0 7 8\n1 -1 nan 9 1\n2 -1 0 2 3\n"),
      gridOf("ascii",
             "0 0 0 9\n1 0 0 255\n2 0 1 7\n0 1 0 0\n1 1 0 9\n1 0\n1 1\n1 2\n1 3\n0\n1 4\n"),
      gridOf("binary_little_endian", gridPoints()),
      importedGrid(),
      "ncols 3\nnrows 3\nxllcorner 10\nyllcorner 20\ncellsize 0.01\nNODATA_value -9\n1 2 3 4 -9 6 "
      "7 "
      "8.5 1e2\n",
      "# columns: 5 over 360 deg, destagger\n0 10 1\n1 5 -1\n2 0 1\n3 -5 2\n"};
}

void change(std::string& bytes, Random& random) {
  if (bytes.empty()) return;
  const std::size_t at = random.below(bytes.size()), size = random.below(8) + 1;
  constexpr const char* kNumbers[] = {"0",     "-1",  "4294967296", "268435457",
                                      "1e39",  "nan", "-inf",       "1000000000",
                                      "65536", "0.0", "",           "#"};
  switch (random.below(7)) {
    case 0: bytes[at] = static_cast<char>(random.below(256)); return;
    case 1: bytes[at] = static_cast<char>('0' + random.below(10)); return;
    case 2: bytes.erase(at, size); return;
    case 3: bytes.insert(at, bytes.substr(random.below(bytes.size()), size)); return;
    case 4: bytes.replace(at, size, kNumbers[random.below(std::size(kNumbers))]); return;
    case 5: bytes.resize(at); return;
    default: bytes[at] = static_cast<char>(bytes[at] ^ 1 << random.below(8)); return;
  }
}

// A file that exists in memory only.
class MemoryFile {
 public:
  MemoryFile() : fd_(::memfd_create("range", MFD_CLOEXEC)) {
    if (!fd_.valid()) didNotRun("memfd_create", "failed", "it needs Linux 3.17");
  }
  std::string path() const { return fmt::format("/proc/self/fd/{}", fd_.get()); }
  void set(const std::string& bytes) {
    const bool done =
        ::ftruncate(fd_.get(), 0) == 0 &&
        ::pwrite(fd_.get(), bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
    if (!done) didNotRun("a file in memory", "could not be written", "free some memory");
  }

 private:
  UniqueFd fd_;
};

class RangeFuzz {
 public:
  // Runs the input of this seed. Returns its fault; empty if the input was handled correctly.
  std::string run(std::uint64_t seed) {
    Random random(seed);
    const bool is_cloud = random.below(4) == 0;
    std::string bytes =
        is_cloud ? clouds_[random.below(clouds_.size())] : good_[random.below(good_.size())];
    for (std::uint64_t n = random.below(4) + 1; n > 0; --n) change(bytes, random);
    file_.set(bytes);
    if (is_cloud) return ofCloud();
    if (bytes.starts_with("MERLIN grid"))
      return ofLoaded(range::readGrid(file_.path(), file_.path(), {}));
    switch (random.below(6)) {
      case 0: return ofTable();
      case 1: return ofPlane();
      case 2: return ofRaw(bytes);
      default: return ofRange({});
    }
  }

  std::map<std::string, std::uint64_t> counts;

 private:
  std::string ofError(const Error& error) {
    ++counts["refused"];
    const bool named = error.what.find(file_.path() + ": ") != std::string::npos;
    if (named && error.what.size() < 800 && isText(error.what)) return {};
    return "no sentence that names the file: " + oneLine(error.what);
  }

  std::string ofRange(const range::RangeOptions& options) {
    return ofLoaded(range::readRange(file_.path(), options));
  }

  std::string ofLoaded(Result<range::LoadedRange> loaded) {
    if (!loaded) return ofError(loaded.error());
    range::RangeImage& image = loaded->image;
    range::Threshold limit;
    limit.per_range = static_cast<float>(10 * range::stepOf(image));
    if (image.geometry.scanner == range::Scanner::kElevation) limit = {};
    range::removeSpikes(image, limit, {});
    range::medianFilter(image, 3, {});
    const auto mesh = range::triangulate(image, range::pointsOf(image, {}), limit, {});
    ++counts[mesh.mesh.triangles.empty() ? "without a triangle" : "meshes"];
    const auto valid = validate(mesh.mesh);
    return valid ? "" : "not a valid mesh: " + valid.error().what;
  }

  std::string ofCloud() {
    const auto cloud = render::points::readCloud(file_.path());
    if (!cloud) return ofError(cloud.error());
    ++counts["clouds"];
    const bool finite =
        std::ranges::all_of(cloud->positions, [](float x) { return std::abs(x) <= 1e18F; });
    if (cloud->size() == 0 || !finite) return "a cloud without points, or with one far away";
    for (const auto& f : cloud->features) {
      if (f.values.size() != cloud->size() * f.dimension) return "a feature of another size";
    }
    return {};
  }

  std::string ofTable() {
    range::RangeOptions options;
    options.angle_table = file_.path();
    range_.set(good_[0]);
    const auto loaded = range::readRange(range_.path(), options);
    if (loaded) ++counts["tables"];
    if (loaded || loaded.error().what.find(range_.path()) == 0) return {};
    return ofError(loaded.error());
  }

  std::string ofPlane() {
    range::RangeImage image;
    image.width = 5;
    image.height = 4;
    const auto plane = range::readPlane("heat", file_.path(), image);
    if (!plane) return ofError(plane.error());
    ++counts["features"];
    return plane->values.size() == 20 * plane->dimension ? "" : "a feature of another size";
  }

  std::string ofRaw(const std::string& bytes) {
    const auto layout = range::parseRawLayout(bytes);
    if (layout) return "a file is a description";
    range::RangeOptions options;
    options.raw = *range::parseRawLayout("3x3:range=f32be,-=u8,confidence=i16le");
    options.raw->interleaved = bytes.size() % 2 == 0;
    options.raw->header_bytes = bytes.size() % 5;
    options.angles_deg = {60, 40};
    return ofRange(options);
  }

  std::vector<std::string> good_ = goodFiles(), clouds_ = test::goodClouds();
  MemoryFile file_, range_;
};

bool fuzz(std::uint64_t seed, std::uint64_t inputs, Report& report) {
  RangeFuzz subject;
  std::uint64_t faults = 0;
  const auto began = std::chrono::steady_clock::now();
  for (std::uint64_t i = 0; i < inputs; ++i) {
    const std::string fault = subject.run(seed + i);
    if (!fault.empty() && ++faults <= 10) note(fmt::format("seed {}: {}", seed + i, fault));
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began;
  for (const char* what : {"meshes", "clouds", "features", "tables", "refused"}) {
    if (subject.counts[what] == 0)
      throw DidNotRun(
          fmt::format("of {} inputs none is one of: {}; --inputs gives more", inputs, what));
  }
  for (const auto& [what, count] : subject.counts) {
    report.text("{:>12}  {}\n", count, what);
    report.figure(what, Measured::of(static_cast<double>(count), inputs, "inputs"), "1");
  }
  report.text("{:>12.0f}  inputs a second\n{:>12}  faults in {} inputs from seed {}\n",
              static_cast<double>(inputs) / seconds.count(), faults, inputs, seed);
  report.figure("faults", Measured::of(static_cast<double>(faults), inputs, "inputs"), "1");
  return faults == 0;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app(
      "Gives damaged range files and point clouds to MERLIN's own readers");
  std::uint64_t inputs = 10'000'000, seed = 1;
  app.option("--inputs", inputs, "Number of files");
  app.option("--seed", seed, "Seed of the first file; each further one has the next seed");
  return app.run("fuzz-ranges", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::fuzz(seed, inputs, report);
  });
}
