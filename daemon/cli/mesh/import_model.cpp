#include "daemon/cli/mesh/import_model.h"

#include <utility>

#include <fmt/format.h>

#include "daemon/cli/foreign_import.h"
#include "daemon/cli/mesh/mesh_memory.h"
#include "daemon/cli/print.h"

namespace merlin::cli {
namespace {

Result<ImportedModel> loadForeign(const std::string& path, const InputKind& kind,
                                  const ModelLimits& limits) {
  ImportedModel model;
  model.format = kind.format;
  const ForeignFile file =
      kind.isPoints()
          ? pointFile(path, limits.output, limits.memory_bytes, limits.surface)
          : ForeignFile{
                kind.kind, path, limits.output, {"--format", kind.ending}, limits.memory_bytes};
  auto report = importForeign(file, [&](const std::string& made) -> Result<Ok> {
    if (const auto fits = roomToRead(made, path, limits.memory_bytes); !fits) return fits;
    auto loaded = render::mesh::readMesh(made);
    if (!loaded)
      return Error{loaded.error().code,
                   "what merlin-import made of it cannot be read: " + loaded.error().what};
    model.loaded = *std::move(loaded);
    return Ok{};
  });
  if (!report) return report.error();
  model.parts = report->count("parts");
  model.welded_edges = report->count("welded_edges").value_or(0);
  model.welded_vertices = report->count("welded_vertices").value_or(0);
  if (kind.isPoints()) {
    model.cloud = pointFactsOf(*report);
    model.format = report->text("format");
  }
  model.loaded.tidied.degenerate += report->count("degenerate").value_or(0);
  model.notes = std::move(report->notes);
  // Notes about reading the mesh that merlin-import has made.
  const auto& more = model.loaded.notes;
  model.notes.insert(model.notes.end(), more.begin(), more.end());
  return model;
}

Result<ImportedModel> loadOwn(const std::string& path, std::uint64_t memory_bytes) {
  if (const auto fits = roomToRead(path, path, memory_bytes); !fits) return fits.error();
  auto loaded = render::mesh::readMeshByContent(path);
  if (!loaded) return loaded.error();
  ImportedModel model;
  model.notes = loaded->notes;
  model.loaded = *std::move(loaded);
  return model;
}

}  // namespace

Result<ImportedModel> loadModel(const std::string& path, const InputKind& kind,
                                const ModelLimits& limits) {
  auto model = kind.reader == InputReader::kForeign ? loadForeign(path, kind, limits)
                                                    : loadOwn(path, limits.memory_bytes);
  if (!model) return model;
  for (const std::string& note : model->notes) printNote(fmt::format("{}: {}", path, note));
  render::mesh::ensureNormals(model->loaded.mesh);
  return model;
}

}  // namespace merlin::cli
