// Makes meshes of any size for ./dev bench size: copies of one scan, laid out as a square of tiles.
//
// The copies are not identical: waves that run over the whole square raise and lower them, so that
// no two copies have equal costs. Every tile is a component of its own, as the scan is. The last
// tile is cut along its x axis, so that the number of triangles is exact.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/mesh/io/mesh_file.h"
#include "tests/bench/command_line.h"

namespace merlin {
namespace {

constexpr float kGap = 0.02F;  // gap between tiles, as a share of the scan's extent
constexpr float kWave = 0.1F;  // height of the waves, as a share of the scan's height

class Tiling {
 public:
  Tiling(const render::mesh::Mesh& tile, std::size_t triangles)
      : tile_(tile), box_(render::mesh::boundingBox(tile.positions)), triangles_(triangles) {
    const std::size_t tiles = (triangles + tile.triangleCount() - 1) / tile.triangleCount();
    across_ = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(tiles))));
    whole_ = triangles / tile.triangleCount();
    cutLast();
  }

  bool write(const WriteBytes& bytes) const {
    const std::size_t vertices = whole_ * tile_.vertexCount() + used_.size();
    const std::string header = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment a scan in tiles, made by tile_scan\n"
        "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        vertices, triangles_);
    if (!bytes(std::as_bytes(std::span(header)))) return false;
    for (std::size_t n = 0; n <= whole_; ++n) {
      if (!writeVertices(n, bytes)) return false;
    }
    for (std::size_t n = 0; n <= whole_; ++n) {
      if (!writeFaces(n, bytes)) return false;
    }
    return true;
  }

 private:
  // Keeps the first triangles along x, and the vertices that they use.
  void cutLast() {
    std::vector<std::uint32_t> order(tile_.triangleCount());
    std::iota(order.begin(), order.end(), 0U);
    const auto x = [&](std::uint32_t t) {
      return tile_.positions[3 * std::size_t{tile_.triangles[3 * std::size_t{t}]}];
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return x(a) < x(b); });
    order.resize(triangles_ - whole_ * tile_.triangleCount());
    place_.assign(tile_.vertexCount(), 0);
    std::vector<bool> seen(tile_.vertexCount(), false);
    for (const std::uint32_t t : order) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = tile_.triangles[3 * std::size_t{t} + k];
        if (!seen[v]) {
          seen[v] = true;
          place_[v] = static_cast<std::uint32_t>(used_.size());
          used_.push_back(v);
        }
        last_.push_back(place_[v]);
      }
    }
  }

  bool writeVertices(std::size_t n, const WriteBytes& bytes) const {
    std::vector<float> rows;
    const auto put = [&](std::uint32_t v) {
      const float* p = &tile_.positions[3 * std::size_t{v}];
      const float x = p[0] + static_cast<float>(n % across_) * step(0);
      const float y = p[1] + static_cast<float>(n / across_) * step(1);
      const float wave = std::sin(2.3F * x / step(0)) * std::cos(1.7F * y / step(1));
      const float z = p[2] + kWave * wave * (box_.high[2] - box_.low[2]);
      rows.insert(rows.end(), {x, y, z});
    };
    if (n < whole_) {
      for (std::uint32_t v = 0; v < tile_.vertexCount(); ++v) put(v);
    } else {
      for (const std::uint32_t v : used_) put(v);
    }
    return bytes(std::as_bytes(std::span(rows)));
  }

  bool writeFaces(std::size_t n, const WriteBytes& bytes) const {
    const std::vector<std::uint32_t>& corners = n < whole_ ? tile_.triangles : last_;
    const auto first = static_cast<std::uint32_t>(n * tile_.vertexCount());
    std::vector<std::byte> rows(corners.size() / 3 * kFace);
    for (std::size_t t = 0; t < corners.size() / 3; ++t) {
      rows[t * kFace] = std::byte{3};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = first + corners[3 * t + k];
        std::memcpy(&rows[t * kFace + 1 + 4 * k], &v, 4);
      }
    }
    return bytes(rows);
  }

  float step(std::size_t k) const { return (1 + kGap) * (box_.high[k] - box_.low[k]); }

  static constexpr std::size_t kFace = 13;  // [bytes]
  const render::mesh::Mesh& tile_;
  render::mesh::Box box_;
  std::size_t triangles_, across_ = 1, whole_ = 0;
  // vertices and triangles of the last tile, which is cut
  std::vector<std::uint32_t> used_, place_, last_;
};

int run(const std::string& scan, double triangles, const std::string& output) {
  const auto loaded = render::mesh::readMesh(scan);
  if (!loaded) {
    fmt::print(stderr, "tile_scan: {}\n", loaded.error().what);
    return 1;
  }
  const Tiling tiling(loaded->mesh, static_cast<std::size_t>(triangles));
  const auto done = writeFile(output, [&](const WriteBytes& bytes) { return tiling.write(bytes); });
  if (done) return 0;
  fmt::print(stderr, "tile_scan: {}\n", done.error().what);
  return 1;
}

}  // namespace
}  // namespace merlin

int main(int argc, char** argv) {
  merlin::bench::CommandLine app(
      "Writes copies of a scan in tiles as a binary PLY with a given number of triangles");
  std::string scan, output;
  double triangles = 1e6;
  app.option("scan", scan, "The scan that each tile is a copy of (.ply, .obj)").required();
  app.option("triangles", triangles, "Number of triangles; it may be written as 1e8")
      .required()
      .range(1.0, 1e9);
  app.option("output", output, "The mesh to be written (.ply)").required();
  if (const auto status = app.parse(argc, argv)) return *status;
  return merlin::run(scan, triangles, output);
}
