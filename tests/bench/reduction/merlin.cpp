// MERLIN itself in the reduction benchmark, measured as its peers are.
//
//   bench_merlin prepare IN OUT.ply                    the mesh that all programs get
//   bench_merlin COST THREADS WEIGHTS IN.ply OUT TRIANGLES...
//
// The second form reduces as far as possible, since the whole hierarchy is MERLIN's product, and
// writes OUT.mrm and, for each number N in TRIANGLES, OUT.N.ply. COST may be "fast": the cost
// quadric with ReduceSettings::fast. WEIGHTS is "default" or NAME=W,NAME=W, which overrides the
// defaults. Each step is measured separately: normals, reduce (which records every collapse),
// dendrogram, write.
// dendrogram, write.
#include <cstdlib>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "render/lod/dendrogram.h"
#include "render/lod/io/mrm_file.h"
#include "render/mesh/io/mesh_file.h"
#include "render/reduce/reduce.h"
#include "tests/bench/reduction/measure.h"
#include "tests/bench/reduction/prepare.h"

namespace merlin::bench {
namespace {

using render::mesh::Mesh;

int fail(const std::string& what) {
  fmt::print(stderr, "{}\n", what);
  return 1;
}

render::reduce::Weights weightsOf(const Mesh& mesh, const std::string& cost, std::string text) {
  render::reduce::Weights weights = render::reduce::findCost(cost)->weights(mesh);
  if (text == "default") return weights;
  for (std::size_t end; !text.empty(); text.erase(0, end == text.npos ? end : end + 1)) {
    end = text.find(',');
    const std::string one = text.substr(0, end);
    const std::size_t equals = one.find('=');
    weights[one.substr(0, equals)] = std::strtof(one.c_str() + equals + 1, nullptr);
  }
  return weights;
}

// Writes OUT.N.ply for each budget N; returns a JSON list that describes the files.
Result<std::string> writeLevels(const render::lod::Dendrogram& model, const std::string& out,
                                const std::vector<std::size_t>& budgets) {
  std::vector<std::string> levels;
  for (const std::size_t budget : budgets) {
    const Mesh mesh = render::lod::extract(model, model.levelFor(budget));
    const auto written = render::mesh::writeMesh(fmt::format("{}.{}.ply", out, budget), mesh);
    if (!written) return written.error();
    levels.push_back(fmt::format("\"{}\": {}", budget, mesh.triangleCount()));
  }
  return fmt::format("{{{}}}", fmt::join(levels, ", "));
}

int reduce(char** argv, const std::vector<std::size_t>& budgets) {
  const bool fast = std::string_view(argv[1]) == "fast";
  const std::string cost = fast ? "quadric" : argv[1], out = argv[5];
  if (!render::reduce::findCost(cost)) return fail(cost + ": no such cost");
  auto loaded = render::mesh::readMesh(argv[4]);
  if (!loaded) return fail(loaded.error().what);
  const Mesh& mesh = loaded->mesh;
  const Cost normals = measure([&] { render::mesh::ensureNormals(loaded->mesh); });

  render::reduce::ReduceSettings settings;
  settings.cost = cost;
  settings.fast = fast;
  settings.threads = static_cast<unsigned>(std::strtoul(argv[2], nullptr, 10));
  settings.weights = weightsOf(mesh, cost, argv[3]);
  Result<render::reduce::Reduction> reduction = Error{Errc::kClosed, "not begun"};
  const Cost reduced = measure([&] { reduction = render::reduce::reduce(mesh, settings); });
  if (!reduction) return fail(reduction.error().what);

  std::optional<render::lod::Dendrogram> model;
  const Cost built = measure([&] { model = render::lod::buildDendrogram(mesh, reduction->log); });
  Result<Ok> written = Ok{};
  const Cost wrote = measure([&] { written = render::lod::writeMrm(out + ".mrm", *model); });
  if (!written) return fail(written.error().what);
  const auto levels = writeLevels(*model, out, budgets);
  if (!levels) return fail(levels.error().what);
  fmt::print(
      "{{\"version\": \"MERLIN\", {}, \"collapses\": {}, \"levels\": {}, \"normals_seconds\": "
      "{:.6f}, \"dendrogram_seconds\": {:.6f}, \"write_seconds\": {:.6f}}}\n",
      json(reduced), reduction->report.collapses, *levels, normals.wall_s, built.wall_s,
      wrote.wall_s);
  return 0;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  using namespace merlin::bench;
  if (argc == 4 && std::string_view(argv[1]) == "prepare") {
    const auto line = prepare(argv[2], argv[3]);
    if (!line) return fail(line.error().what);
    fmt::print("{}\n", *line);
    return 0;
  }
  if (argc < 7) {
    return fail(
        fmt::format("usage: {0} prepare IN OUT.ply\n       {0} COST THREADS WEIGHTS IN.ply "
                    "OUT TRIANGLES...",
                    argv[0]));
  }
  std::vector<std::size_t> budgets;
  for (int i = 6; i < argc; ++i) budgets.push_back(std::strtoul(argv[i], nullptr, 10));
  return reduce(argv, budgets);
}
