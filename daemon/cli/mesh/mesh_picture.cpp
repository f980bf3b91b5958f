// merlin mesh picture: draws models, each at one or several resolutions, side by side in one image.
#include <memory>

#include <fmt/format.h>

#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/edge_bands.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/mesh/mesh_memory.h"
#include "daemon/cli/mesh/view_options.h"
#include "daemon/cli/mesh/weight_options.h"
#include "daemon/cli/print.h"
#include "render/image/png_writer.h"
#include "render/lod/finest_level.h"
#include "render/reduce/edge_lengths.h"

namespace merlin::cli {
namespace {

struct PictureOptions {
  std::vector<std::string> models;
  std::vector<double> percents = {100};
  std::string output;
  View view;
  bool edges = false;
  WeightOptions weights;
  std::uint64_t memory = 0;  // limit in bytes; 0: the free memory

  std::size_t limit() const { return memoryLimit(memory); }
};

// Appends to `strip` a picture of the edges of the level, coloured by their weighted lengths, at
// the scale of the finest level.
Result<Ok> appendEdges(const PictureOptions& options, const std::string& path,
                       const render::lod::Dendrogram& model, std::size_t level,
                       render::image::Image& strip) {
  if (auto fits = roomForEdges(path, model.trianglesAt(level), options.limit()); !fits) return fits;
  render::mesh::Mesh mesh = render::lod::extract(model, level);
  render::mesh::ensureNormals(mesh);
  const auto weights = options.weights.weightsFor("pattern", mesh);
  if (!weights) return weights.error();
  const auto lengths = render::reduce::edgeLengths(mesh, *weights);
  if (!lengths) return Error{lengths.error().code, path + ": " + lengths.error().what};
  render::mesh::Mesh bands = edgeBands(mesh, sizesOf(*lengths), options.view);
  if (level > 0) bands = framed(std::move(bands), render::lod::extract(model, 0));
  const render::lod::Dendrogram shown = render::lod::oneLevel(bands);
  const SystemClock clock;
  auto painter =
      render::frame::OffscreenModel::make(shown, bandView(options.view).asAsked(), clock);
  if (!painter) return painter.error();
  strip.append(painter->draw(0));
  return Ok{};
}

Result<Ok> appendSurface(const PictureOptions& options, const render::lod::Dendrogram& model,
                         const std::vector<std::size_t>& levels, render::image::Image& strip) {
  const SystemClock clock;
  auto painter = render::frame::OffscreenModel::make(model, options.view.asAsked(), clock);
  if (!painter) return painter.error();
  for (const std::size_t level : levels) strip.append(painter->draw(level));
  return Ok{};
}

Result<Ok> appendModel(const PictureOptions& options, const std::string& path,
                       render::image::Image& strip) {
  if (auto fits = roomToRead(path, path, options.limit()); !fits) return fits;
  const auto model = openModel(path);
  if (!model) return model.error();
  std::vector<std::size_t> levels;
  for (const double percent : options.percents) {
    levels.push_back(model->levelFor(
        static_cast<std::size_t>(percent / 100 * static_cast<double>(model->triangleCount()))));
  }
  Result<Ok> done = Ok{};
  if (!options.edges) done = appendSurface(options, *model, levels, strip);
  for (std::size_t i = 0; options.edges && done && i < levels.size(); ++i)
    done = appendEdges(options, path, *model, levels[i], strip);
  if (!done) return done;
  for (const std::size_t level : levels)
    printOut("{}: {} of {} triangles\n", path, model->trianglesAt(level), model->triangleCount());
  return Ok{};
}

Result<Ok> checkEdges(const PictureOptions& options) {
  const bool weighted = options.weights.hasPreset() || !options.weights.weights.empty();
  if (weighted && !options.edges)
    return Error{Errc::kInvalidArgument, "--preset and --weight: need --edges"};
  if (options.edges &&
      (options.view.model.style.wireframe || !options.view.model.show.feature.empty()))
    return Error{Errc::kInvalidArgument, "--edges: cannot be combined with --wireframe or --show"};
  return Ok{};
}

int picture(const PictureOptions& options) {
  if (const auto good = checkEdges(options); !good) return fail(good.error());
  for (const std::string& model : options.models) {
    if (const auto writable = checkOutputs(model, {options.output}); !writable)
      return fail(writable.error());
  }
  if (const auto named = checkEnding(options.output, "picture", ".png"); !named)
    return fail(named.error());
  render::gl::prepareSoftwareGl(0);
  render::image::Image strip;
  for (const std::string& model : options.models) {
    if (const auto done = appendModel(options, model, strip); !done) return fail(done.error());
  }
  const auto written =
      render::image::writePng(options.output, strip.width, strip.height, strip.pixels);
  if (!written) return fail(written.error());
  printOut("{}: {} x {}\n", options.output, strip.width, strip.height);
  return kExitDone;
}

}  // namespace

void addMeshPicture(Command mesh, Run& run) {
  const auto options = std::make_shared<PictureOptions>();
  Command command = mesh.subcommand("picture",
                                    "Draw models, each at one resolution or several, side by side "
                                    "in a PNG file.\nExample: merlin "
                                    "mesh picture scan.mrm --percent 100 5 -o both.png");
  command
      .option("models", options->models,
              "Models (.mrm) or meshes (" + render::mesh::readableEndings() + ")")
      .required()
      .typeName("MODEL");
  command.option("-o", options->output, "The PNG file").required().typeName("FILE.png");
  command
      .option("--percent", options->percents,
              "Resolutions to draw, in percent of the triangles of the finest; one image for each")
      .range(0.0, 100.0);
  command.option("--width", options->view.width, "Width of one image in pixels")
      .range(16, 8192)
      .showDefault();
  command.option("--height", options->view.height, "Height of one image in pixels")
      .range(16, 8192)
      .showDefault();
  options->view.addTo(command);
  command.flag("--wireframe", options->view.model.style.wireframe, "Draw edges instead of faces");
  command.flag(
      "--edges", options->edges,
      "Draw the edges coloured by their weighted lengths, from red for the shortest, which "
      "`merlin mesh reduce --cost pattern` collapses first, to blue for the longest: shows "
      "what weights do before a reduction");
  options->weights.addTo(
      command,
      "With --edges: initial weights of the features: default (those of --cost pattern), or "
      "weights that Gourley's dissertation of 1998 used for its data",
      "With --edges: weight of a feature: geometry, normal, curvature, boundary, colour or any "
      "other feature of the mesh. 0 ignores the feature");
  command
      .option("--memory", options->memory,
              "Maximum memory that a model may take, such as 900M or 16G; the default is the free "
              "memory")
      .size()
      .typeName("SIZE");
  command.callback([options, &run] { run = [options] { return picture(*options); }; });
}

}  // namespace merlin::cli
