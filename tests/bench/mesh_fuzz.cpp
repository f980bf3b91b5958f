#include "tests/bench/mesh_fuzz.h"

#include <cmath>
#include <exception>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/random.h"
#include "render/lod/dendrogram.h"
#include "render/mesh/non_manifold.h"
#include "render/reduce/reduce.h"
#include "tests/bench/hostile_meshes.h"

namespace merlin::bench {
namespace {

using render::lod::Dendrogram;
using render::mesh::Mesh;

// Returns the message about an invalid mesh; empty if the mesh is valid.
std::string faultOf(const Mesh& mesh) {
  const auto valid = validate(mesh);
  return valid ? "" : valid.error().what;
}

std::string faultOfSplit(Mesh mesh) {
  if (render::mesh::splitNonManifold(mesh).added > 0) return "a split mesh can be split again";
  return "";
}

std::string faultOfLevels(const Dendrogram& model, const Mesh& mesh, Random& random) {
  if (model.triangleCount() != mesh.triangleCount())
    return "triangles are lost at the finest level";
  for (std::size_t level = 1; level < model.levels(); ++level) {
    if (model.trianglesAt(level) > model.trianglesAt(level - 1)) return "triangles come back";
    if (!(model.errorAt(level) >= model.errorAt(level - 1))) return "the error falls";
  }
  if (!std::isfinite(model.errorAt(model.levels() - 1))) return "the error is not finite";
  if (model.trianglesAt(model.levels() - 1) == 0) return "no triangle is left";
  std::vector<std::uint32_t> corners(3 * model.triangleCount());
  for (int cut = 0; cut < 4; ++cut) {
    const std::size_t budget = random.below(model.triangleCount() + 2);
    const std::size_t level = model.levelFor(budget);
    const std::size_t n = model.cut(level, corners);
    if (n > budget && level + 1 < model.levels()) return "a cut is above its budget";
    for (std::size_t i = 0; i < 3 * n; ++i) {
      if (corners[i] >= model.nodeCount() - 2 * level) return "a cut has a dead node";
    }
    for (std::size_t i = 0; i < 3 * n; i += 3) {
      if (corners[i] == corners[i + 1] || corners[i + 1] == corners[i + 2] ||
          corners[i + 2] == corners[i])
        return "a cut has a triangle with a node twice";
    }
  }
  return faultOf(render::lod::extract(model, random.below(model.levels())));
}

render::reduce::ReduceSettings settingsFor(const Mesh& mesh, const char* cost, Random& random) {
  render::reduce::ReduceSettings settings;
  settings.cost = cost;
  settings.threads = 1;
  settings.preserve_topology = random.below(4) == 0;
  settings.preserve_components = random.below(4) == 0;
  settings.fast = settings.cost == "quadric" && random.below(4) == 0;
  if (settings.cost == "quadric" && random.below(8) == 0) {
    settings.locked.resize(mesh.vertexCount());
    for (std::size_t v = 0; v < settings.locked.size(); ++v)
      settings.locked[v] = random.below(8) == 0;
  }
  if (random.below(8) == 0) settings.min_triangles = random.below(10);
  if (random.below(8) == 0) settings.max_error_percent = random.uniform(0, 10);
  return settings;
}

std::string faultOfReduction(const Mesh& mesh, const char* cost, Random& random, MeshFuzz& fuzz) {
  const auto settings = settingsFor(mesh, cost, random);
  const auto reduction = render::reduce::reduce(mesh, settings);
  if (!reduction) {
    ++fuzz.counts[fmt::format("refused by {}: {}", cost, reduction.error().what)];
    return "";
  }
  ++fuzz.counts[fmt::format("reduced by {}", cost)];
  const Dendrogram model = render::lod::buildDendrogram(mesh, reduction->log);
  auto checked = Dendrogram::make(model.arrays(), nullptr);
  if (!checked) return checked.error().what;
  if (model.trianglesAt(model.levels() - 1) != reduction->report.triangles)
    return "the report's triangles are not the model's";
  return faultOfLevels(model, mesh, random);
}

std::string fuzzOne(std::uint64_t seed, MeshFuzz& fuzz) {
  auto& counts = fuzz.counts;
  Mesh mesh = hostileMesh(seed);
  if (const std::string refusal = faultOf(mesh); !refusal.empty()) {
    ++counts["refused: " + kindOf(refusal)];
    return "";
  }
  const render::mesh::TidyReport tidied = render::mesh::tidy(mesh);
  counts["mended: triangles with a vertex twice"] += tidied.degenerate;
  counts["mended: triangles that were there twice"] += tidied.duplicate;
  counts["mended: triangles on the back of another"] += tidied.opposite;
  counts["mended: vertices of no triangle"] += tidied.unused;
  if (mesh.triangles.empty()) {
    ++counts["refused: no triangles"];
    return "";
  }
  const render::mesh::SplitReport split = render::mesh::splitNonManifold(mesh);
  counts["mended: non-manifold edges"] += split.edges;
  counts["mended: non-manifold vertices"] += split.vertices;
  if (const std::string fault = faultOf(mesh); !fault.empty()) return "after mending: " + fault;
  if (const std::string fault = faultOfSplit(mesh); !fault.empty()) return fault;
  render::mesh::ensureNormals(mesh);
  Random random(seed);
  const render::reduce::Cost& cost =
      render::reduce::costs()[random.below(render::reduce::costs().size())];
  const std::string fault = faultOfReduction(mesh, cost.name, random, fuzz);
  return fault.empty() ? "" : fmt::format("{}: {}", cost.name, fault);
}

}  // namespace

std::string kindOf(const std::string& what) {
  constexpr std::pair<const char*, const char*> kKinds[] = {
      {"not multiples of 3", "half a vertex or triangle"},
      {"the limit is", "a coordinate that is no place"},
      {"there is no vertex", "an index out of range"},
      {"values for", "a feature of another size"},
      {" has ", "a feature that is no number"}};
  for (const auto& [words, kind] : kKinds) {
    if (what.find(words) == std::string::npos) continue;
    const std::size_t colon = what.starts_with("feature") ? 0 : what.find(": ");
    const bool cost = render::reduce::findCost(what.substr(0, colon)) != nullptr;
    return cost ? what.substr(0, colon + 2) + kind : kind;
  }
  return what;
}

bool MeshFuzz::run(std::uint64_t seed) {
  ++counts["meshes"];
  try {
    fault = fuzzOne(seed, *this);
  } catch (const std::exception& e) {
    fault = fmt::format("thrown: {}", e.what());
  }
  return fault.empty();
}

}  // namespace merlin::bench
