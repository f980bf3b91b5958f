// merlin mesh fuse: makes one surface from several range images with known poses.
#include <algorithm>
#include <iterator>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/process_memory.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/import_grid.h"
#include "daemon/cli/mesh/import_range.h"
#include "daemon/cli/mesh/input_kinds.h"
#include "daemon/cli/mesh/late_bar.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/mesh/mesh_memory.h"
#include "daemon/cli/mesh/outwards.h"
#include "daemon/cli/mesh/pose_file.h"
#include "daemon/cli/mesh/reduction_step.h"
#include "daemon/cli/print.h"
#include "render/fuse/fuse.h"

namespace merlin::cli {
namespace {

namespace fuse = render::fuse;

struct MeshFuse {
  std::vector<std::string> scans, poses;
  std::string output;
  RangeImport range;  // options for reading all scans
  fuse::FuseSettings settings;
  std::uint64_t memory = 0;  // limit in bytes; 0: the free memory
  unsigned threads = 0;
  bool lost_says_nothing = false, local = false, json = false, outwards = false;

  std::size_t limit() const { return memoryLimit(memory); }
  bool makesModel() const { return output.ends_with(".mrm"); }
};

// The scans, relative to a common origin, and the facts in them that apply to the result.
struct Scans {
  std::vector<render::range::RangeImage> images;
  render::mesh::Origin origin{};
  std::vector<FeatureFacts> features;  // features with one value per pixel, each listed once
  bool in_metres = true;               // whether all scans are in metres
};

// Facts about the file that was written, and the duration of each step [s].
struct FusedFile {
  render::mesh::WrittenMesh mesh{};
  std::optional<std::size_t> coarsest{};  // number of triangles of a model's coarsest level
  double reading = 0, fusing = 0, writing = 0;
  Outwards outwards{};
};

Result<ImportedRange> readScan(const MeshFuse& options, std::size_t number) {
  const std::string& path = options.scans[number];
  const auto kind = options.range.isRaw() ? std::nullopt : inputKindOf(path);
  auto loaded = loadRange(
      path, options.range, false,
      readerOf(kind,
               {{}, options.output, options.limit(), options.range.hdu, options.range.variable}));
  if (!loaded) return loaded.error();
  for (const std::string& note : loaded->notes) printNote(fmt::format("{}: {}", path, note));
  // Called only if there are filters, because filterRange() also checks the memory for a mesh,
  // which is not made here.
  if (options.range.filters()) {
    const auto filtered =
        filterRange(path, options.range, options.limit(), {threadsOr(options.threads)}, *loaded);
    if (!filtered) return filtered.error();
  }
  if (!options.poses.empty()) {
    const auto pose = readPose(options.poses[number]);
    if (!pose) return pose.error();
    loaded->image.geometry.T_world_scanner = *pose;
  }
  if (const std::string fault = fuse::faultOf(loaded->image); !fault.empty())
    return Error{Errc::kInvalidArgument, path + ": " + fault};
  return loaded;
}

// Combines the facts of all scans (`all`) about each feature into scans.features. Prints a note if
// the units of a feature differ.
void joinFacts(const MeshFuse& options, const std::vector<FeatureFacts>& all, Scans& scans) {
  for (const FeatureFacts& one : all) {
    if (std::ranges::find(scans.features, one.name, &FeatureFacts::name) != scans.features.end())
      continue;
    std::vector<FeatureFacts> same;
    std::ranges::copy_if(all, std::back_inserter(same),
                         [&](const FeatureFacts& f) { return f.name == one.name; });
    bool differ = false;
    scans.features.push_back(joined(same, differ));
    if (differ)
      printNote(
          fmt::format("{}: the scans give the feature {} in different units; its unit is left out, "
                      "and its values are blended without conversion",
                      options.output, one.name));
  }
}

// Makes all scans relative to an origin near the first scan, because their coordinates may be the
// large numbers of a map.
void placeScans(Scans& scans) {
  scans.origin = takeOrigin(scans.images.front().geometry);
  for (std::size_t i = 1; i < scans.images.size(); ++i)
    subtract(scans.origin, scans.images[i].geometry);
}

Result<Scans> readScans(const MeshFuse& options) {
  Scans scans;
  std::vector<FeatureFacts> facts;
  for (std::size_t i = 0; i < options.scans.size(); ++i) {
    auto scan = readScan(options, i);
    if (!scan) return scan.error();
    for (const render::range::Plane& plane : scan->image.planes)
      if (plane.dimension == 1) facts.push_back(factsOf(plane, scan->image));
    scans.in_metres = scans.in_metres && scan->in_metres;
    scans.images.push_back(std::move(scan->image));
  }
  joinFacts(options, facts, scans);
  const bool placed = std::ranges::any_of(scans.images, [](const auto& scan) {
    return scan.geometry.T_world_scanner != render::range::kIdentity;
  });
  placeScans(scans);
  if (!placed && scans.images.size() > 1)
    return Error{Errc::kInvalidArgument,
                 options.scans.front() +
                     ": neither this scan nor the others have a camera transform; fusion needs to "
                     "know where each stood: the key camera of a PGM, or CAM11 to CAM34 of a FITS "
                     "image (render/range/io/README.md), or --pose FILE"};
  return scans;
}

Result<fuse::Fused> fuseScans(MeshFuse& options,
                              const std::vector<render::range::RangeImage>& scans) {
  std::size_t pixels = 0;
  for (const auto& scan : scans) pixels += scan.pixels();
  if (options.settings.voxel == 0) options.settings.voxel = fuse::voxelFor(scans);
  options.settings.background_is_empty = !options.lost_says_nothing;
  // The free memory, the default limit, already excludes the scans; a limit for the whole command
  // (--memory) includes them.
  const std::size_t used = options.memory > 0 ? peakMemory() : 0;
  options.settings.memory = options.limit() - std::min(options.limit(), used);
  const SystemClock clock;
  LateBar bar("fusing", pixels, clock);
  auto fused = fuse::fuse(scans, options.settings, bar.work(options.threads));
  if (!fused) return Error{fused.error().code, options.output + ": " + fused.error().what};
  bar.finish();
  return fused;
}

Result<Ok> writeFused(const MeshFuse& options, const Scans& scans, const render::mesh::Mesh& mesh,
                      FusedFile& file) {
  if (!options.makesModel()) {
    auto written = render::mesh::writeMesh(options.output, mesh,
                                           options.local ? render::mesh::Origin{} : scans.origin);
    if (!written) return written.error();
    file.mesh = *std::move(written);
    return Ok{};
  }
  double reducing = 0;  // this time is reported as a part of writing
  const std::string about = (scans.in_metres ? "unit=m\n" : "") + aboutOrigin(scans.origin) +
                            aboutFeatures(scans.features);
  const auto coarsest = writeReduced(
      {options.output, options.output, about, options.limit(), options.threads}, mesh, reducing);
  if (!coarsest) return coarsest.error();
  file.coarsest = *coarsest;
  return Ok{};
}

const FeatureFacts* factsFor(const Scans& scans, const std::string& name) {
  const auto found = std::ranges::find(scans.features, name, &FeatureFacts::name);
  return found == scans.features.end() ? nullptr : &*found;
}

nlohmann::ordered_json featuresOf(const Scans& scans, const render::mesh::Mesh& mesh) {
  nlohmann::ordered_json features = nlohmann::ordered_json::array();
  for (const auto& f : mesh.features) {
    nlohmann::ordered_json feature = {{"name", f.name}, {"dimension", f.dimension}};
    if (const FeatureFacts* facts = factsFor(scans, f.name)) {
      if (!facts->unit.empty()) feature["unit"] = facts->unit;
      feature["range"] = {facts->low, facts->high};
    }
    features.push_back(std::move(feature));
  }
  return features;
}

void printFeatures(const Scans& scans, const render::mesh::Mesh& mesh) {
  for (const auto& f : mesh.features) {
    if (const FeatureFacts* facts = factsFor(scans, f.name))
      printOut("  feature   {}, {:.6g} to {:.6g}{}{}\n", f.name, facts->low, facts->high,
               facts->unit.empty() ? "" : " ", facts->unit);
    else
      printOut("  feature   {} x {}\n", f.name, f.dimension);
  }
}

void reportJson(const MeshFuse& options, const Scans& scans, const fuse::Fused& fused,
                const FusedFile& file) {
  nlohmann::ordered_json json = {
      {"scans", options.scans},
      {"output", options.output},
      {"voxel", options.settings.voxel},
      {"truncation", options.settings.truncation * options.settings.voxel},
      {"closed", options.settings.close},
      {"triangles", fused.mesh.triangleCount()},
      {"vertices", fused.mesh.vertexCount()},
      {"measured_vertices", fused.measured},
      {"vertices_added", fused.split},
      {"blocks", fused.blocks},
      {"blocks_looked_at", fused.looked_at},
      {"features", featuresOf(scans, fused.mesh)},
      {"companion_files", file.mesh.companions},
      {"left_out", file.mesh.left_out},
      {"seconds", {{"reading", file.reading}, {"fusing", file.fusing}, {"writing", file.writing}}},
      {"peak_memory_mb", peakMemory() >> 20}};
  if (file.coarsest) json["triangles_coarsest"] = *file.coarsest;
  if (scans.origin != render::mesh::Origin{}) {
    json["origin"] = scans.origin;
    json["origin_added"] =
        !options.makesModel() && hasOrigin(scans.origin, options.local, file.mesh);
  }
  file.outwards.addTo(json);
  printJsonLine(json);
}

void report(const MeshFuse& options, const Scans& scans, const fuse::Fused& fused,
            const FusedFile& file) {
  if (options.json) return reportJson(options, scans, fused, file);
  printOut("{}: {} triangles, {} vertices\n", options.output, fused.mesh.triangleCount(),
           fused.mesh.vertexCount());
  printOut("  read      {} scans\n", options.scans.size());
  printOut("  volume    {} blocks of 8 x 8 x 8 voxels, edge {:.4g}, of {} blocks examined\n",
           fused.blocks, options.settings.voxel, fused.looked_at);
  const std::size_t inferred = fused.mesh.vertexCount() - fused.measured;
  if (options.settings.close)
    printOut("  closed    {} vertices that no scan saw (feature measured is 0)\n", inferred);
  if (!options.makesModel())
    printOrigin(scans.origin, options.local, file.mesh);
  else if (scans.origin != render::mesh::Origin{})
    printOut("  origin    the model's (0, 0, 0) is at {}, {}, {}\n", scans.origin[0],
             scans.origin[1], scans.origin[2]);
  printFeatures(scans, fused.mesh);
  printWritten(file.mesh);
  if (file.coarsest) printOut("  levels    down to {} triangles\n", *file.coarsest);
  printOut("  {:.2f} s: reading {:.2f}, fusing {:.2f}, writing {:.2f}; peak memory {} MB\n",
           file.reading + file.fusing + file.writing, file.reading, file.fusing, file.writing,
           peakMemory() >> 20);
}

// Checks the options. Errors: kInvalidArgument. If --angles took a scan as its value, the scan is
// removed from the values of --angles.
Result<Ok> checkFuse(MeshFuse& options) {
  if (const auto scan = options.range.takeInput())
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: is taken for a value of --angles, which may be a file or two "
                             "numbers; give --angles FILE after the scans",
                             *scan)};
  if (options.scans.empty())
    return Error{Errc::kInvalidArgument, "no scans are given; name their files before the options"};
  if (!options.makesModel()) {
    if (const auto known = render::mesh::checkMeshEnding(options.output); !known)
      return Error{known.error().code, known.error().what + "; models as .mrm"};
  }
  for (const std::string& scan : options.scans) {
    if (const auto free = checkOutputs(scan, {options.output}); !free) return free;
  }
  if (!options.poses.empty() && options.poses.size() != options.scans.size())
    return Error{Errc::kInvalidArgument,
                 fmt::format("--pose: {} files for {} scans; give one for each, in their order",
                             options.poses.size(), options.scans.size())};
  if (options.lost_says_nothing && !options.settings.close)
    return Error{Errc::kInvalidArgument, "--ignore-background: needs --close"};
  if (options.local && options.makesModel()) return localIsForMeshes(options.output);
  return Ok{};
}

std::size_t bytesOfScans(const Scans& scans) {
  std::size_t bytes = 0;
  for (const auto& image : scans.images) bytes += image.bytes();
  return bytes;
}

int fuseFiles(MeshFuse& options) {
  const SystemClock clock;
  const std::size_t limit = options.limit();
  FusedFile file;
  if (const auto good = checkFuse(options); !good) return fail(good.error());
  const Timestamp began = clock.now();
  const auto scans = readScans(options);
  if (!scans) return fail(scans.error());
  const Timestamp read = clock.now();
  auto fused = fuseScans(options, scans->images);
  if (!fused) return fail(fused.error());
  if (fused->not_numbers > 0)
    printNote(fmt::format("{}: {} vertices have 0 in a feature that no scan has there",
                          options.output, fused->not_numbers));
  const auto outwards =
      faceOutwards(options.output, options.outwards,
                   roomBeside(fused->mesh, bytesOfScans(*scans), limit), fused->mesh);
  if (!outwards) return fail(outwards.error());
  file.outwards = *outwards;
  const Timestamp done = clock.now();
  if (const auto written = writeFused(options, *scans, fused->mesh, file); !written)
    return fail(written.error());
  file.reading = toSeconds(read - began);
  file.fusing = toSeconds(done - read);
  file.writing = toSeconds(clock.now() - done);
  report(options, *scans, *fused, file);
  return kExitDone;
}

void addVolume(Command command, MeshFuse& options) {
  command
      .option("--voxel", options.settings.voxel,
              "Edge of a voxel, in the scans' units; by default the median step between pixels")
      .positive()
      .typeName("LENGTH");
  command
      .option("--truncation", options.settings.truncation,
              "Distance from a surface, in voxels, up to which a scan contributes its distance "
              "(truncation): more for noisy scans, less for thin parts")
      .range(1.0, 100.0)
      .showDefault();
  command
      .option("--max-edge", options.settings.max_edge,
              "Longest edge of a scan's surface; by default 10 times the step between pixels")
      .positive()
      .typeName("LENGTH");
  command.flag("--close", options.settings.close,
               "Close the surface: space that no scan saw counts as inside, and the feature "
               "measured is 0 on the surface there");
  command.flag("--ignore-background", options.lost_says_nothing,
               "With --close: ignore rays without a return. By default, such a ray counts as "
               "having passed through empty space if its window of 3 x 3 pixels has no return");
}

}  // namespace

void addMeshFuse(Command mesh, Run& run) {
  const auto options = std::make_shared<MeshFuse>();
  Command command = mesh.subcommand(
      "fuse",
      "Make one surface of several range images whose files say where the scanner stood (the key "
      "camera). Where scans overlap, distances, colours and other features are blended by "
      "confidence and angle of incidence. Scans are not aligned to one another."
      "\nExample: merlin mesh fuse scan1.pgm scan2.pgm scan3.pgm --close -o bust.mrm");
  command.option("scans", options->scans, "The range images, as merlin mesh import reads them")
      .typeName("SCAN...");
  command
      .option("-o", options->output,
              "The result: a model (.mrm) or a mesh (.ply, .obj, .glb, .gltf, .stl, .iv)")
      .required()
      .typeName("OUT");
  command
      .option("--pose", options->poses,
              "File with a scan's camera transform, three or four rows of four numbers; once for "
              "each scan, in their order. It overrides what the scans say")
      .repeatable()
      .typeName("FILE");
  command.option("--scale", options->range.scale, "Metres per unit of the ranges, of all scans")
      .positive()
      .typeName("METRES_PER_UNIT");
  options->range.addReadingTo(command);
  addVolume(command, *options);
  addOutwards(command, options->outwards);
  addLimits(command, options->memory, options->threads);
  addLocal(command, options->local);
  command.flag("--json", options->json, "Print the report as JSON, for programs");
  command.callback([options, &run] { run = [options] { return fuseFiles(*options); }; });
}

}  // namespace merlin::cli
