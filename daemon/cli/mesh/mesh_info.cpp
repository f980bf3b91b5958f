// merlin mesh info: prints the contents of a mesh or a model.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/print.h"
#include "render/lod/finest_level.h"

namespace merlin::cli {
namespace {

struct InfoOptions {
  std::string file;
  bool json = false;
};

// A model and, if it was read from a mesh file, the repairs that were necessary.
struct Opened {
  std::optional<render::lod::Dendrogram> model;
  std::vector<Repair> repairs;
  std::string mended;
};

Result<Opened> open(const std::string& path) {
  Opened opened;
  if (path.ends_with(".mrm")) {
    auto model = openModel(path);
    if (!model) return model.error();
    opened.model = *std::move(model);
    return opened;
  }
  const auto loaded = loadMesh(path);
  if (!loaded) return loaded.error();
  opened.model = render::lod::oneLevel(loaded->mesh);
  opened.repairs = repairsOf(*loaded);
  opened.mended = mendedText(*loaded);
  return opened;
}

void printJson(const std::string& file, const Opened& opened) {
  using Json = nlohmann::ordered_json;
  const render::lod::Dendrogram& model = *opened.model;
  const auto& a = model.arrays();
  const render::mesh::Box box = render::lod::finestBox(model);
  Json features = Json::array();
  for (const auto& f : a.features)
    features.push_back({{"name", f.name}, {"dimension", f.dimension}});
  Json json = {{"file", file},
               {"triangles", model.triangleCount()},
               {"vertices", model.vertexCount()},
               {"levels", model.levels()},
               {"triangles_coarsest", model.trianglesAt(model.levels() - 1)},
               {"features", std::move(features)},
               {"texture_bytes", a.texture.size()},
               {"box", {{"low", box.low}, {"high", box.high}}},
               {"diagonal", box.diagonal()},
               {"about", a.about}};
  for (const Repair& r : opened.repairs) json[r.key] = r.count;
  printJsonLine(json);
}

void printText(const std::string& file, const Opened& opened) {
  const render::lod::Dendrogram& model = *opened.model;
  const auto& a = model.arrays();
  const render::mesh::Box box = render::lod::finestBox(model);
  printOut("{}: {} triangles, {} vertices\n", file, model.triangleCount(), model.vertexCount());
  if (model.levels() > 1) {
    printOut("  levels    {}, down to {} triangles (error estimate {:.3g})\n", model.levels(),
             model.trianglesAt(model.levels() - 1), model.errorAt(model.levels() - 1));
  }
  for (const auto& f : a.features) printOut("  feature   {} x {}\n", f.name, f.dimension);
  if (!a.texture.empty()) printOut("  texture   {} bytes\n", a.texture.size());
  printOut("  box       {:.6g} {:.6g} {:.6g} to {:.6g} {:.6g} {:.6g}, diagonal {:.6g}\n",
           box.low[0], box.low[1], box.low[2], box.high[0], box.high[1], box.high[2],
           box.diagonal());
  if (!opened.mended.empty()) printOut("  {}\n", opened.mended);
  std::string_view about = a.about;
  while (!about.empty()) {
    const std::size_t n = std::min(about.find('\n'), about.size());
    printOut("  made by   {}\n", about.substr(0, n));
    about.remove_prefix(std::min(n + 1, about.size()));
  }
}

int info(const InfoOptions& options) {
  const auto opened = open(options.file);
  if (!opened) return fail(opened.error());
  (options.json ? printJson : printText)(options.file, *opened);
  return kExitDone;
}

}  // namespace

void addMeshInfo(Command mesh, Run& run) {
  const auto options = std::make_shared<InfoOptions>();
  Command command = mesh.subcommand(
      "info",
      "Show the contents of a mesh or a model, and the "
      "repairs that reading a mesh needed.\nExample: merlin mesh info scan.mrm --json");
  command
      .option("file", options->file,
              "Model (.mrm) or mesh (" + render::mesh::readableEndings() + ")")
      .required()
      .typeName("FILE");
  command.flag("--json", options->json, "Print JSON, for programs");
  command.callback([options, &run] { run = [options] { return info(*options); }; });
}

}  // namespace merlin::cli
