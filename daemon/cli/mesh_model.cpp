#include <cmath>

#include "daemon/cli/mesh.h"
#include "render/lod/io/mrm_file.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::cli {

Result<render::Dendrogram> openModel(const std::string& path) {
  if (path.ends_with(".mrm")) return render::readMrm(path);
  auto loaded = render::readMesh(path);
  if (!loaded) return loaded.error();
  render::ensureNormals(loaded->mesh);
  return asModel(loaded->mesh);
}

render::Dendrogram asModel(const render::Mesh& mesh) {
  render::CollapseLog nothing;
  nothing.features.resize(mesh.features.size());
  return render::buildDendrogram(mesh, nothing);
}

void LevelChoice::addTo(CLI::App& command) {
  CLI::Option_group* group =
      command.add_option_group("resolution", "Which resolution; without any: the finest");
  group->add_option("--percent", percent, "Of the triangles")->check(CLI::Range(0.0, 100.0));
  group->add_option("--triangles", triangles, "At most so many");
  group
      ->add_option(
          "--error", error_percent,
          "The coarsest whose error estimate is at most this, percent of the box' diagonal")
      ->check(CLI::NonNegativeNumber);
  group->add_option("--error-units", error_units, "The same, in the model's units")
      ->check(CLI::NonNegativeNumber);
  group->require_option(0, 1);
}

std::size_t LevelChoice::levelOf(const render::Dendrogram& model) const {
  if (triangles) return model.levelFor(*triangles);
  if (percent)
    return model.levelFor(static_cast<std::size_t>(
        std::floor(*percent / 100 * static_cast<double>(model.triangleCount()))));
  if (error_percent) {
    const float diagonal = render::boundingBox(model.arrays().positions).diagonal();
    return model.levelForError(static_cast<float>(*error_percent / 100) * diagonal);
  }
  if (error_units) return model.levelForError(static_cast<float>(*error_units));
  return 0;
}

}  // namespace merlin::cli
