// merlin mesh picture: models, or one model at several resolutions, side by side in a PNG file.
#include <cmath>
#include <memory>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh.h"
#include "daemon/wall/picture.h"
#include "render/out/png.h"

namespace merlin::cli {
namespace {

struct PictureOptions {
  std::vector<std::string> models;
  std::vector<double> percents = {100};
  std::string output, backend = "egl";
  int width = 640, height = 480;
  double yaw_deg = 30, pitch_deg = 0;
  render::RenderSettings render;
};

// A picture of pictures, side by side.
struct Strip {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  // RGBA

  void append(std::span<const std::uint8_t> image, int image_width) {
    std::vector<std::uint8_t> wider;
    for (int row = 0; row < height; ++row) {
      const auto old = pixels.begin() + std::ptrdiff_t{4} * row * width;
      wider.insert(wider.end(), old, old + std::ptrdiff_t{4} * width);
      const auto fresh = image.begin() + std::ptrdiff_t{4} * row * image_width;
      wider.insert(wider.end(), fresh, fresh + std::ptrdiff_t{4} * image_width);
    }
    pixels = std::move(wider);
    width += image_width;
  }
};

Eigen::Isometry3f viewOf(const PictureOptions& options) {
  constexpr float kRadian = std::numbers::pi_v<float> / 180;
  Eigen::Isometry3f view = Eigen::Isometry3f::Identity();
  view.rotate(
      Eigen::AngleAxisf(static_cast<float>(options.yaw_deg) * kRadian, Eigen::Vector3f::UnitY()));
  view.rotate(
      Eigen::AngleAxisf(static_cast<float>(options.pitch_deg) * kRadian, Eigen::Vector3f::UnitX()));
  return view;
}

Result<Ok> appendModel(const PictureOptions& options, const std::string& path,
                       const render::TilePlan& plan, Strip& strip) {
  const auto model = openModel(path);
  if (!model) return model.error();
  const SystemClock clock;
  const auto picture = wall::Picture::make(*model, plan, options.render, 1.0, clock);
  if (!picture) return picture.error();
  for (const double percent : options.percents) {
    const std::size_t level = model->levelFor(
        static_cast<std::size_t>(percent / 100 * static_cast<double>(model->triangleCount())));
    (*picture)->draw(viewOf(options), level, Timestamp::max());
    strip.append((*picture)->pixels(), options.width);
    fmt::print("{}: {} of {} triangles\n", path, model->trianglesAt(level), model->triangleCount());
  }
  return Ok{};
}

int picture(PictureOptions options) {
  render::prepareSoftwareGl(0);
  options.render.backend =
      options.backend == "osmesa" ? render::GlBackend::kOsmesa : render::GlBackend::kEgl;
  render::TilesSettings tiles;
  tiles.tile_width = tiles.frame_width = options.width;
  tiles.tile_height = tiles.frame_height = options.height;
  tiles.tiles = {{"model", render::TileKind::kOperator, 0, 0, 0}};
  const auto plan = render::planTiles(tiles);
  if (!plan) return fail(plan.error());
  Strip strip{0, options.height, {}};
  for (const std::string& model : options.models) {
    if (const auto done = appendModel(options, model, *plan, strip); !done)
      return fail(done.error());
  }
  const auto written = render::writePng(options.output, strip.width, strip.height, strip.pixels);
  if (!written) return fail(written.error());
  fmt::print("{}: {} x {}\n", options.output, strip.width, strip.height);
  return kExitDone;
}

}  // namespace

void addMeshPicture(CLI::App& mesh, Run& run) {
  const auto options = std::make_shared<PictureOptions>();
  CLI::App* command = mesh.add_subcommand(
      "picture",
      "Models, each at one resolution or several, side by side as a PNG file.\nExample: merlin "
      "mesh picture scan.mrm --percent 100 5 -o both.png");
  command->add_option("models", options->models, ".mrm, .ply or .obj")
      ->required()
      ->type_name("MODEL");
  command->add_option("-o", options->output, "The file")->required()->type_name("FILE.png");
  command->add_option("--percent", options->percents, "Of the triangles, one picture each")
      ->check(CLI::Range(0.0, 100.0));
  command->add_option("--width", options->width, "Of one picture, pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  command->add_option("--height", options->height, "Of one picture, pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  command->add_option("--yaw", options->yaw_deg, "Turn about the vertical axis, degrees")
      ->capture_default_str();
  command
      ->add_option(
          "--pitch", options->pitch_deg,
          "Turn about the horizontal axis before it, degrees; -90 for a model whose up is z")
      ->capture_default_str();
  command->add_option("--brightness", options->render.look.brightness, "Multiplies colours")
      ->check(CLI::Range(0.1, 10.0))
      ->capture_default_str();
  command->add_flag("--wireframe", options->render.look.wireframe, "Edges instead of faces");
  command->add_option("--backend", options->backend, "Which windowless OpenGL draws")
      ->check(CLI::IsMember({"egl", "osmesa"}))
      ->capture_default_str();
  command->callback([options, &run] { run = [options] { return picture(*options); }; });
}

}  // namespace merlin::cli
