#include "tests/bench/hostile_meshes.h"

#include <cmath>
#include <limits>

#include "daemon/base/random.h"

namespace merlin::bench {
namespace {

using render::mesh::Feature;
using render::mesh::Mesh;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class Maker {
 public:
  explicit Maker(std::uint64_t seed) : random_(seed * 0x9E3779B97F4A7C15 + 1) {}

  Mesh make() {
    switch (random_.below(8)) {
      case 0: break;  // an empty mesh
      case 1: patch(1, 1); break;
      case 2: addVertices(3 + random_.below(4)), soup(1 + random_.below(3)); break;
      case 3: addVertices(3 + size(8)), soup(1 + size(12)); break;
      case 4: fan(); break;
      case 5: patch(1 + size(2), 1 + size(2)), damage(); break;
      case 6: patch(1 + size(2), 1), patch(1, 1), join(); break;
      default: tube(); break;
    }
    place();
    if (chance(3)) damage();
    addFeatures();
    if (chance(8)) spoil();
    return std::move(mesh_);
  }

 private:
  bool chance(std::uint64_t of) { return random_.below(of) == 0; }
  // Returns a number that is usually below `n`, sometimes up to five times as large: most faults
  // show in small meshes, which are quick to test.
  std::uint64_t size(std::uint64_t n) { return random_.below(chance(16) ? 5 * n : n); }
  std::uint32_t anyVertex() {
    return static_cast<std::uint32_t>(
        random_.below(std::max<std::uint64_t>(1, mesh_.vertexCount())));
  }
  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.triangles.insert(mesh_.triangles.end(), {a, b, c});
  }
  void addVertices(std::uint64_t n) {
    for (std::uint64_t i = 0; i < 3 * n; ++i)
      mesh_.positions.push_back(static_cast<float>(random_.uniform(-1, 1)));
  }

  void soup(std::uint64_t triangles) {
    for (; triangles > 0; --triangles) addTriangle(anyVertex(), anyVertex(), anyVertex());
  }

  void patch(std::uint64_t columns, std::uint64_t rows) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertexCount());
    const auto width = static_cast<std::uint32_t>(columns + 1);
    for (std::uint64_t y = 0; y <= rows; ++y) {
      for (std::uint64_t x = 0; x <= columns; ++x)
        mesh_.positions.insert(mesh_.positions.end(), {static_cast<float>(x), static_cast<float>(y),
                                                       static_cast<float>(random_.uniform())});
    }
    for (std::uint32_t y = 0; y < rows; ++y) {
      for (std::uint32_t x = 0; x < columns; ++x) {
        const std::uint32_t a = first + y * width + x;
        addTriangle(a, a + 1, a + width + 1);
        addTriangle(a, a + width + 1, a + width);
      }
    }
  }

  // Adds many triangles around one vertex or one edge.
  void fan() {
    const auto n = static_cast<std::uint32_t>(1 + size(8));
    addVertices(n + 2);
    const bool edge = chance(2);
    for (std::uint32_t i = 0; i < n; ++i) addTriangle(0, edge ? 1 : 2 + (i + 1) % n, 2 + i);
  }

  // Adds a closed ring of quads, sometimes twisted to a Moebius strip.
  void tube() {
    const auto n = static_cast<std::uint32_t>(3 + size(3));
    const std::uint32_t twist = chance(3);
    for (std::uint32_t i = 0; i < n; ++i) {
      const double a = 6.283185307 * i / n;
      for (const float z : {0.0F, 1.0F})
        mesh_.positions.insert(mesh_.positions.end(), {static_cast<float>(std::cos(a)),
                                                       static_cast<float>(std::sin(a)), z});
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t p = 2 * i, last = i + 1 == n;
      const std::uint32_t r = (p + 2) % (2 * n) + (last & twist),
                          s = (p + 2) % (2 * n) + (last ? 1 - twist : 1);
      addTriangle(p, r, p + 1);
      addTriangle(p + 1, r, s);
    }
  }

  void join() {
    const std::uint32_t from = anyVertex(), to = anyVertex();
    for (std::uint32_t& v : mesh_.triangles) v = v == from ? to : v;
  }

  // Moves vertices: makes them coincident or collinear, or scales the mesh to extreme or flat
  // shapes.
  void place() {
    if (mesh_.positions.empty()) return;
    auto& p = mesh_.positions;
    constexpr float kScales[] = {1e-38F, 1e-20F, 1e-6F, 1e6F, 1e15F, 9e17F};
    switch (random_.below(10)) {
      case 0:
        for (float& x : p) x *= kScales[random_.below(6)];
        break;
      case 1: {
        const float scale = kScales[random_.below(6)];
        for (float& x : p) x = std::fmin(std::fmax(x * scale, -1e18F), 1e18F);
        break;
      }
      case 2:
        for (std::size_t i = random_.below(3); i < p.size(); i += 3) p[i] = 0;
        break;
      case 3:
        for (float& x : p) x = std::round(x);
        break;
      case 4:
        for (std::size_t i = 0; i < p.size(); ++i) p[i] = p[i % 3];
        break;
      case 5:
        for (std::size_t i = 0; i < p.size(); i += 3) p[i] *= 1e-7F;
        break;
      case 6:
        for (float& x : p) x += 1e7F;
        break;
      case 7: p[random_.below(p.size())] = 1e18F; break;
      default: break;
    }
  }

  void damage() {
    for (std::uint64_t n = 1 + random_.below(4); n > 0 && !mesh_.triangles.empty(); --n) {
      auto& t = mesh_.triangles;
      const std::size_t at = 3 * random_.below(t.size() / 3),
                        other = 3 * random_.below(t.size() / 3);
      switch (random_.below(5)) {
        case 0: t[at] = t[at + 1]; break;
        case 1: addTriangle(t[at + 1], t[at + 2], t[at]); break;
        case 2: addTriangle(t[at + 1], t[at], t[at + 2]); break;
        case 3: std::swap(t[at], t[at + 1]); break;
        default: t[at] = t[other]; break;
      }
    }
  }

  void addFeatures() {
    constexpr std::pair<const char*, std::size_t> kKinds[] = {
        {"colour", 3}, {"heat", 1}, {"label", 1}, {"texcoord", 2}, {"normal", 3}, {"wide", 7}};
    for (const auto& [name, dimension] : kKinds) {
      if (!chance(4)) continue;
      Feature f{name, dimension, std::vector<float>(mesh_.vertexCount() * dimension)};
      constexpr float kScales[] = {0, 1, 1, 1, 1e-30F, 1e30F, 3e38F};
      const float scale = kScales[random_.below(7)];
      for (float& x : f.values) x = scale * static_cast<float>(random_.uniform());
      if (f.name == "label") {
        for (float& x : f.values) x = static_cast<float>(random_.below(3));
      }
      mesh_.features.push_back(std::move(f));
    }
  }

  // Inserts a fault that validate() has to find.
  void spoil() {
    const auto any = [&](std::vector<float>& values, float x) {
      if (!values.empty()) values[random_.below(values.size())] = x;
    };
    const float x = chance(3) ? kNaN : chance(2) ? kInfinity : -2e18F;
    switch (random_.below(6)) {
      case 0: any(mesh_.positions, x); break;
      case 1:
        if (!mesh_.features.empty()) any(mesh_.features[0].values, chance(2) ? kNaN : kInfinity);
        break;
      case 2:
        if (!mesh_.triangles.empty())
          mesh_.triangles[random_.below(mesh_.triangles.size())] =
              static_cast<std::uint32_t>(mesh_.vertexCount() + (chance(2) ? 0 : random_.next()));
        break;
      case 3: mesh_.triangles.push_back(0); break;
      case 4: mesh_.positions.push_back(0); break;
      default:
        if (!mesh_.features.empty()) mesh_.features[0].values.push_back(0);
        break;
    }
  }

  Random random_;
  Mesh mesh_;
};

}  // namespace

render::mesh::Mesh hostileMesh(std::uint64_t seed) { return Maker(seed).make(); }

}  // namespace merlin::bench
