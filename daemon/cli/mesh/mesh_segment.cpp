// merlin mesh segment: clusters the vertices of a mesh in pattern space; the clusters' numbers
// become the feature "label".
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/mesh/view_options.h"
#include "daemon/cli/print.h"
#include "render/image/png_writer.h"
#include "render/segment/segment.h"

namespace merlin::cli {
namespace {

struct SegmentOptions {
  std::string input, output, picture;
  std::vector<std::string> weights;
  render::SegmentSettings settings;
  View view;
  bool json = false;
};

void setFeature(render::Mesh& mesh, render::Feature feature) {
  if (render::Feature* old = mesh.find(feature.name))
    *old = std::move(feature);
  else
    mesh.features.push_back(std::move(feature));
}

Result<Ok> draw(const SegmentOptions& options, const render::Mesh& mesh) {
  render::prepareSoftwareGl(0);
  const render::Dendrogram model = asModel(mesh);
  const SystemClock clock;
  View view = options.view;
  if (view.model.show.feature.empty()) view.model.show.feature = "label";
  auto painter = render::OffscreenModel::make(model, view.asAsked(), clock);
  if (!painter) return painter.error();
  const render::Image image = painter->draw(0);
  return render::writePng(options.picture, image.width, image.height, image.pixels);
}

void report(const SegmentOptions& options, const render::Segmentation& s, double seconds,
            const render::WrittenMesh& written) {
  if (options.json) {
    const nlohmann::ordered_json json = {
        {"output", options.output}, {"segments", s.sizes.size()},
        {"sizes", s.sizes},         {"vertices", s.labels.size()},
        {"error", s.error},         {"seconds", seconds},
        {"beside", written.beside}, {"left_out", written.left_out}};
    printJsonLine(json);
    return;
  }
  say("{}: {} segments of {} vertices, RMS distance in pattern space {:.4g}, {:.2f} s\n",
      options.output, s.sizes.size(), s.labels.size(), s.error, seconds);
  constexpr std::size_t kMost = 20;
  const std::size_t shown = std::min(kMost, s.sizes.size());
  say("  sizes {}{}\n",
      fmt::join(s.sizes.begin(), s.sizes.begin() + static_cast<std::ptrdiff_t>(shown), " "),
      s.sizes.size() > kMost ? " ..." : "");
  printWritten(written);
}

int segmentMesh(const SegmentOptions& options) {
  if (const auto known = render::checkMeshEnding(options.output); !known)
    return fail(known.error());
  if (const auto writable = checkOutputs(options.input, {options.output, options.picture});
      !writable)
    return fail(writable.error());
  if (!options.picture.empty()) {
    const auto named = checkEnding(options.picture, "picture", ".png");
    if (!named) return fail(named.error());
  }
  auto loaded = loadMesh(options.input);
  if (!loaded) return fail(loaded.error());
  render::Mesh& mesh = loaded->mesh;
  render::SegmentSettings settings = options.settings;
  for (const std::string& text : options.weights) {
    if (const auto set = setWeight(text, settings.weights); !set) return fail(set.error());
  }
  if (const auto free = render::checkBeside(options.output, mesh); !free) return fail(free.error());
  const SystemClock clock;
  const Timestamp began = clock.now();
  const auto segmentation = render::segment(mesh, settings);
  if (!segmentation) return fail(segmentation.error());
  const double seconds = toSeconds(clock.now() - began);
  setFeature(mesh, {"label", 1, {segmentation->labels.begin(), segmentation->labels.end()}});
  const auto written = render::writeMesh(options.output, mesh);
  if (!written) return fail(written.error());
  if (!options.picture.empty()) {
    if (const auto drawn = draw(options, mesh); !drawn) return fail(drawn.error());
  }
  report(options, *segmentation, seconds, *written);
  return kExitDone;
}

}  // namespace

void addMeshSegment(Command mesh, Run& run) {
  const auto options = std::make_shared<SegmentOptions>();
  Command command = mesh.subcommand(
      "segment",
      "Divide a mesh into connected segments of similar vertices. Their numbers become the feature "
      "label; 0 is the largest segment.\nExample: merlin mesh segment scan.ply -o parts.ply "
      "--segments 12 --weight normal=1 --weight colour=2");
  command.option("input", options->input, "The mesh: " + render::readableEndings())
      .required()
      .typeName("IN");
  command.option("-o", options->output, "The mesh with labels: .ply, .glb or .gltf")
      .required()
      .typeName("OUT.ply")
      .check([](const std::string& path) {
        const bool carries =
            path.ends_with(".ply") || path.ends_with(".glb") || path.ends_with(".gltf");
        return carries ? "" : path + ": only .ply, .glb and .gltf can hold labels";
      });
  command.option("--segments", options->settings.segments, "Number of segments")
      .required()
      .range(std::size_t{1}, std::size_t{1} << 24);
  command
      .option("--weight", options->weights,
              "Weight of a feature: geometry, normal, curvature, or any other feature of the mesh; "
              "the default is normal=1, and colour=1 if the mesh has colours")
      .typeName("FEATURE=W");
  command.option("--picture", options->picture, "Draw the segments, each in a colour of its own")
      .typeName("FILE.png");
  options->view.addTo(command);
  command.flag("--json", options->json, "Print the report as JSON, for programs");
  command.callback([options, &run] { run = [options] { return segmentMesh(*options); }; });
}

}  // namespace merlin::cli
