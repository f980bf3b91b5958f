// merlin mesh segment: divides a mesh into segments by clustering its vertices in pattern space;
// the number of each vertex's segment becomes its feature "label".
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
#include "render/lod/finest_level.h"
#include "render/segment/segment.h"

namespace merlin::cli {
namespace {

struct SegmentOptions {
  std::string input, output, picture;
  std::vector<std::string> weights;
  render::segment::SegmentSettings settings;
  View view;
  bool json = false;
  bool local = false;  // whether to write coordinates without the origin
};

void setFeature(render::mesh::Mesh& mesh, render::mesh::Feature feature) {
  if (render::mesh::Feature* old = mesh.find(feature.name))
    *old = std::move(feature);
  else
    mesh.features.push_back(std::move(feature));
}

Result<Ok> draw(const SegmentOptions& options, const render::mesh::Mesh& mesh) {
  render::gl::prepareSoftwareGl(0);
  const render::lod::Dendrogram model = render::lod::oneLevel(mesh);
  const SystemClock clock;
  View view = options.view;
  if (view.model.show.feature.empty()) view.model.show.feature = "label";
  auto painter = render::frame::OffscreenModel::make(model, view.asAsked(), clock);
  if (!painter) return painter.error();
  const render::image::Image image = painter->draw(0);
  return render::image::writePng(options.picture, image.width, image.height, image.pixels);
}

void report(const SegmentOptions& options, const render::segment::Segmentation& s, double seconds,
            const render::mesh::WrittenMesh& written) {
  if (options.json) {
    const nlohmann::ordered_json json = {{"output", options.output},
                                         {"segments", s.sizes.size()},
                                         {"sizes", s.sizes},
                                         {"vertices", s.labels.size()},
                                         {"error", s.error},
                                         {"seconds", seconds},
                                         {"companion_files", written.companions},
                                         {"left_out", written.left_out}};
    printJsonLine(json);
    return;
  }
  printOut("{}: {} segments of {} vertices, RMS distance in pattern space {:.4g}, {:.2f} s\n",
           options.output, s.sizes.size(), s.labels.size(), s.error, seconds);
  constexpr std::size_t kMost = 20;
  const std::size_t shown = std::min(kMost, s.sizes.size());
  printOut("  sizes {}{}\n",
           fmt::join(s.sizes.begin(), s.sizes.begin() + static_cast<std::ptrdiff_t>(shown), " "),
           s.sizes.size() > kMost ? " ..." : "");
  printWritten(written);
}

int segmentMesh(const SegmentOptions& options) {
  if (const auto known = render::mesh::checkMeshEnding(options.output); !known)
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
  render::mesh::Mesh& mesh = loaded->mesh;
  render::segment::SegmentSettings settings = options.settings;
  for (const std::string& text : options.weights) {
    if (const auto set = setWeight(text, settings.weights); !set) return fail(set.error());
  }
  if (const auto free = render::mesh::checkCompanions(options.output, mesh); !free)
    return fail(free.error());
  const SystemClock clock;
  const Timestamp began = clock.now();
  const auto segmentation = render::segment::segment(mesh, settings);
  if (!segmentation) return fail(segmentation.error());
  const double seconds = toSeconds(clock.now() - began);
  setFeature(mesh, {"label", 1, {segmentation->labels.begin(), segmentation->labels.end()}});
  const auto written = render::mesh::writeMesh(
      options.output, mesh, options.local ? render::mesh::Origin{} : loaded->origin);
  if (!written) return fail(written.error());
  if (!options.picture.empty()) {
    if (const auto drawn = draw(options, mesh); !drawn) return fail(drawn.error());
  }
  report(options, *segmentation, seconds, *written);
  if (!options.json) printOrigin(loaded->origin, options.local, *written);
  return kExitDone;
}

}  // namespace

void addMeshSegment(Command mesh, Run& run) {
  const auto options = std::make_shared<SegmentOptions>();
  Command command = mesh.subcommand("segment",
                                    "Divide a mesh into connected segments of similar vertices. "
                                    "The number of its segment becomes "
                                    "the feature label of each vertex; 0 is the largest "
                                    "segment.\nExample: merlin mesh segment scan.ply -o parts.ply "
                                    "--segments 12 --weight normal=1 --weight colour=2");
  command.option("input", options->input, "The mesh: " + render::mesh::readableEndings())
      .required()
      .typeName("IN");
  command.option("-o", options->output, "The mesh with labels: .ply, .glb or .gltf")
      .required()
      .typeName("OUT.ply")
      .check([](const std::string& path) {
        const bool carries =
            path.ends_with(".ply") || path.ends_with(".glb") || path.ends_with(".gltf");
        return carries ? "" : path + ": only .ply, .glb and .gltf files can store labels";
      });
  command.option("--segments", options->settings.segments, "Number of segments")
      .required()
      .range(std::size_t{1}, std::size_t{1} << 24);
  command
      .option("--weight", options->weights,
              "Weight of a feature: geometry, normal, curvature, or any other feature of the mesh; "
              "the default is normal=1, and colour=1 if the mesh has colours")
      .typeName("FEATURE=W");
  command
      .option("--picture", options->picture,
              "Write an image of the segments, each in its own colour")
      .typeName("FILE.png");
  options->view.addTo(command);
  addLocal(command, options->local);
  command.flag("--json", options->json, "Print the report as JSON, for programs");
  command.callback([options, &run] { run = [options] { return segmentMesh(*options); }; });
}

}  // namespace merlin::cli
