// merlin mesh picture: draws models, each at one or several resolutions, side by side in one image.
#include <memory>

#include <fmt/format.h>

#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/mesh/view_options.h"
#include "daemon/cli/print.h"
#include "render/image/png_writer.h"

namespace merlin::cli {
namespace {

struct PictureOptions {
  std::vector<std::string> models;
  std::vector<double> percents = {100};
  std::string output;
  View view;
};

Result<Ok> appendModel(const PictureOptions& options, const std::string& path,
                       render::image::Image& strip) {
  const auto model = openModel(path);
  if (!model) return model.error();
  const SystemClock clock;
  auto painter = render::frame::OffscreenModel::make(*model, options.view.asAsked(), clock);
  if (!painter) return painter.error();
  for (const double percent : options.percents) {
    const std::size_t level = model->levelFor(
        static_cast<std::size_t>(percent / 100 * static_cast<double>(model->triangleCount())));
    strip.append(painter->draw(level));
    printOut("{}: {} of {} triangles\n", path, model->trianglesAt(level), model->triangleCount());
  }
  return Ok{};
}

int picture(const PictureOptions& options) {
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
  command.callback([options, &run] { run = [options] { return picture(*options); }; });
}

}  // namespace merlin::cli
