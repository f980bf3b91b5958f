// merlin mesh import: converts a range image, an elevation map, a mesh, a model or a point cloud,
// in any supported format, to a mesh or a multiresolution model.
#include "daemon/cli/mesh/mesh_import.h"

#include <memory>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/import_grid.h"
#include "daemon/cli/mesh/import_model.h"
#include "daemon/cli/mesh/import_range.h"
#include "daemon/cli/mesh/import_report.h"
#include "daemon/cli/mesh/input_kinds.h"
#include "daemon/cli/mesh/late_bar.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/mesh/mesh_memory.h"
#include "daemon/cli/mesh/outwards.h"
#include "daemon/cli/mesh/reduction_step.h"
#include "daemon/cli/print.h"
#include "render/image/image_file.h"
#include "render/mesh/io/gzip.h"
#include "render/points/io/cloud_file.h"

namespace merlin::cli {
namespace {

ImportNames namesOf(const MeshImport& options) {
  return {options.input(), options.output, options.json, options.local};
}

std::size_t limitOf(const MeshImport& options) { return memoryLimit(options.memory); }

bool makesModel(const MeshImport& options) { return options.output.ends_with(".mrm"); }
bool makesImage(const MeshImport& options) { return options.output.ends_with(".pgm"); }

// Measures the time from one call of lap() to the next.
class Stopwatch {
 public:
  explicit Stopwatch(const Clock& clock) : clock_(clock), last_(clock.now()) {}
  double lap() {
    const Timestamp now = clock_.now();
    const double seconds = toSeconds(now - last_);
    last_ = now;
    return seconds;
  }

 private:
  const Clock& clock_;
  Timestamp last_;
};

// Returns lines for the model's text "about": the unit, the features' units and ranges, the origin,
// and the place of a map.
std::string aboutRange(const ImportedRange& range) {
  std::string text = range.in_metres ? "unit=m\n" : "";
  const auto& geometry = range.image.geometry;
  if (!geometry.projection.empty()) text += fmt::format("map.projection={}\n", geometry.projection);
  if (geometry.origin)
    text += fmt::format("map.origin={} {}\n", (*geometry.origin)[0], (*geometry.origin)[1]);
  return text + aboutOrigin(range.origin) + aboutFeatures(range.features);
}

Result<ImportedFile> writeModel(const MeshImport& options, const render::mesh::Mesh& mesh,
                                const std::string& about, ImportTimes& times) {
  ImportedFile written{mesh.triangleCount(), mesh.vertexCount(), {}, {}};
  const auto coarsest = writeReduced(
      {options.output, options.input(), about, limitOf(options), options.threads, options.progress},
      mesh, times.reducing);
  if (!coarsest) return coarsest.error();
  written.coarsest = *coarsest;
  return written;
}

Result<ImportedFile> writeOutput(const MeshImport& options, const render::mesh::Mesh& mesh,
                                 const render::mesh::Origin& origin, const std::string& about,
                                 ImportTimes& times) {
  if (makesModel(options)) return writeModel(options, mesh, about, times);
  auto done = render::mesh::writeMesh(options.output, mesh,
                                      options.local ? render::mesh::Origin{} : origin);
  if (!done) return done.error();
  return ImportedFile{mesh.triangleCount(), mesh.vertexCount(), {}, *std::move(done)};
}

Result<Ok> addTexture(const MeshImport& options, render::mesh::Mesh& mesh) {
  if (options.texture.empty()) return Ok{};
  if (!mesh.find("texcoord") || mesh.find("texcoord")->dimension != 2)
    return Error{Errc::kInvalidArgument,
                 options.input() + ": has no texture coordinates for the picture of --texture"};
  if (const auto fits = roomForPicture(options.texture, sizeOf(mesh), limitOf(options)); !fits)
    return fits;
  auto picture = render::image::readImage(options.texture);
  if (!picture) return picture.error();
  mesh.texture = std::move(picture->file);
  return Ok{};
}

// Writes the filtered range image as PGM, without a mesh, and prints the report.
Result<Ok> writeImage(const MeshImport& options, ImportedRange& range, ImportTimes& times,
                      Stopwatch& watch) {
  const auto done = render::range::writeRange(options.output, range.image);
  if (!done) return done.error();
  times.writing = watch.lap();
  ImportedFile written;
  written.mesh.format = "pgm";
  for (const auto& plane : range.image.planes) written.mesh.left_out.push_back(plane.name);
  if (!options.quiet) reportRange(namesOf(options), range, written, times);
  return Ok{};
}

// Checks that no option was given that has no effect if the output is a range image. Errors:
// kInvalidArgument.
Result<Ok> checkImageOptions(const MeshImport& options) {
  if (!makesImage(options)) return Ok{};
  std::string option = options.range.givenForMesh();
  if (options.outwards) option = "--outwards";
  if (!options.texture.empty()) option = "--texture";
  if (option.empty()) return Ok{};
  return Error{Errc::kInvalidArgument,
               fmt::format("{}: {} is for a mesh or a model; a range image (.pgm) has the ranges "
                           "alone: leave the option out, or name another output, such as OUT.mrm",
                           options.output, option)};
}

Result<Ok> importRange(const MeshImport& options, const std::optional<InputKind>& kind) {
  if (const auto good = checkImageOptions(options); !good) return good;
  const std::size_t limit = limitOf(options);
  const SystemClock clock;
  Stopwatch watch(clock);
  ImportTimes times;
  auto range = loadRange(
      options.input(), options.range, !options.texture.empty(),
      readerOf(kind, {{}, options.output, limit, options.range.hdu, options.range.variable}));
  if (!range) return range.error();
  for (const std::string& note : range->notes) printNote(options.input() + ": " + note);
  times.reading = watch.lap();
  LateBar bar("importing", range->image.pixels(), clock, options.progress);
  const auto work = bar.work(options.threads);
  const auto filtered = filterRange(options.input(), options.range, limitOf(options),
                                    render::range::partOf(work, 0, 0.5), *range);
  if (!filtered) return filtered.error();
  times.filtering = watch.lap();
  if (makesImage(options)) return writeImage(options, *range, times, watch);
  const auto meshed =
      meshRange(options.input(), options.range, render::range::partOf(work, 0.5, 1), *range);
  if (!meshed) return meshed.error();
  bar.finish();
  render::mesh::Mesh& mesh = range->mesh.mesh;
  const std::size_t room = roomBeside(mesh, range->image.bytes(), limit);
  if (const auto faced = faceOutwards(options.input(), options.outwards, room, mesh); !faced)
    return faced.error();
  if (const auto added = addTexture(options, mesh); !added) return added.error();
  if (range->mesh.not_numbers > 0)
    printNote(fmt::format("{}: {} values of features were not numbers and were replaced by 0",
                          options.input(), range->mesh.not_numbers));
  times.meshing = watch.lap();
  const auto written = writeOutput(options, mesh, range->origin, aboutRange(*range), times);
  if (!written) return written.error();
  times.writing = watch.lap() - times.reducing;
  if (!options.quiet) reportRange(namesOf(options), *range, *written, times);
  return Ok{};
}

// Checks that the file is not compressed by gzip. Errors, with the name of the file: those of
// packedFileError().
Result<Ok> checkNotPacked(const std::string& path) {
  const auto file = MappedFile::open(path);
  if (!file || !render::mesh::isGzip(file->text())) return Ok{};
  const Error error = render::mesh::packedFileError(file->text());
  return Error{error.code, path + ": " + error.what};
}

Result<Ok> checkMeshInput(const MeshImport& options, const std::optional<InputKind>& kind) {
  const std::string option = options.range.anyGiven();
  const std::string& path = options.input();
  const std::string read = fmt::format(
      "supported formats are {} for range images, {} for meshes, {} for point clouds, and {}",
      render::range::readableRanges(), render::mesh::readableEndings(),
      render::points::readableClouds(), foreignFormats());
  if (const auto there = checkIsThere(path); !there) return there;
  if (!kind && path.ends_with(".mrm"))
    return Error{Errc::kUnsupported,
                 fmt::format("{0}: is a model for the wall already; merlin mesh export {0} -o "
                             "OUT.ply makes a mesh of it",
                             path)};
  if (const auto plain = kind ? Result<Ok>(Ok{}) : checkNotPacked(path); !plain) return plain;
  if (!kind)
    return Error{Errc::kUnsupported, path + ": has a format that MERLIN does not read; " + read};
  if (!option.empty())
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: {} is for range images; {}", path, option, read)};
  if (makesImage(options))
    return Error{Errc::kUnsupported, options.output + ": only range images are written as PGM"};
  return Ok{};
}

// Multiplies the coordinates and the origin by `factor`. Errors, with the name of the file:
// kMalformed (coordinates beyond 10^18).
Result<Ok> scale(const std::string& path, double factor, ImportedModel& model) {
  const auto multiply = [factor](render::mesh::Origin& origin) {
    for (double& x : origin) x *= factor;
  };
  render::mesh::Mesh& mesh = model.loaded.mesh;
  for (float& x : mesh.positions) x = static_cast<float>(x * factor);
  multiply(model.loaded.origin);
  if (model.cloud) multiply(model.cloud->origin);
  if (const auto valid = validate(mesh); !valid)
    return Error{valid.error().code, path + ": after --scale, " + valid.error().what};
  return Ok{};
}

// Returns lines for the model's text "about": the unit, the origin and the map projection, as far
// as they are known.
std::string aboutModel(const MeshImport& options, const InputKind& kind,
                       const ImportedModel& model) {
  const bool metres = options.range.scale || kind.unit() == "m";
  return (metres ? "unit=m\n" : "") + aboutOrigin(model.loaded.origin) +
         (model.cloud ? aboutPoints(*model.cloud) : std::string());
}

Result<Ok> importMesh(const MeshImport& options, const std::optional<InputKind>& kind) {
  const SystemClock clock;
  Stopwatch watch(clock);
  ImportTimes times;
  if (const auto good = checkMeshInput(options, kind); !good) return good.error();
  const std::size_t limit = limitOf(options);
  auto model = loadModel(options.input(), *kind, {options.output, limit, options.points.surface});
  if (!model) return model.error();
  render::mesh::Mesh& mesh = model->loaded.mesh;
  const auto scaled = scale(options.input(), options.range.scale.value_or(1), *model);
  if (!scaled) return scaled.error();
  const auto outwards =
      faceOutwards(options.input(), options.outwards, roomBeside(mesh, 0, limit), mesh);
  if (!outwards) return outwards.error();
  model->outwards = *outwards;
  if (const auto added = addTexture(options, mesh); !added) return added.error();
  times.reading = watch.lap();
  const auto written =
      writeOutput(options, mesh, model->origin(), aboutModel(options, *kind, *model), times);
  if (!written) return written.error();
  times.writing = watch.lap() - times.reducing;
  if (!options.quiet) reportModel(namesOf(options), *model, *written, times);
  return Ok{};
}

// Checks that options for point clouds were given for a point cloud only. Errors: kInvalidArgument.
Result<Ok> checkPointOptions(const MeshImport& options, const std::optional<InputKind>& kind) {
  if (!options.points.anyGiven() || !kind || kind->isPoints()) return Ok{};
  return Error{
      Errc::kInvalidArgument,
      fmt::format("{}: --depth, --neighbours and --trim are for point clouds, which are {}",
                  options.input(), render::points::readableClouds())};
}

Result<Ok> checkOptions(MeshImport& options) {
  if (const auto input = options.range.takeInput()) options.inputs.push_back(*input);
  if (options.inputs.size() != 1)
    return Error{
        Errc::kInvalidArgument,
        fmt::format("{} inputs are given; one file is imported at a time", options.inputs.size())};
  if (!makesModel(options) && !makesImage(options)) {
    if (const auto known = render::mesh::checkMeshEnding(options.output); !known)
      return Error{known.error().code,
                   known.error().what + "; models as .mrm, range images as .pgm"};
  }
  if (options.local && (makesModel(options) || makesImage(options)))
    return localIsForMeshes(options.output);
  return checkOutputs(options.input(), {options.output});
}

}  // namespace

Result<Ok> importFile(MeshImport& options) {
  if (const auto good = checkOptions(options); !good) return good;
  if (options.range.isRaw()) return importRange(options, {});
  const auto kind = inputKindOf(options.input());
  if (const auto good = checkPointOptions(options, kind); !good) return good;
  return kind && kind->isGrid() ? importRange(options, kind) : importMesh(options, kind);
}

void addImportOptions(Command command, MeshImport& options) {
  command
      .option("--scale", options.range.scale,
              "Metres per unit of the file's ranges, heights or coordinates")
      .positive()
      .typeName("METRES_PER_UNIT");
  options.range.addTo(command);
  options.points.addTo(command);
  command
      .option("--texture", options.texture,
              "Picture over the whole range image, or of a mesh with texture coordinates; it is "
              "stored in the model, or beside the mesh")
      .typeName("FILE.png|.jpg");
  addOutwards(command, options.outwards);
  addLimits(command, options.memory, options.threads);
}

void addMeshImport(Command mesh, Run& run) {
  const auto options = std::make_shared<MeshImport>();
  Command command = mesh.subcommand("import",
                                    "Make a mesh, or a model that is ready for the wall (.mrm, "
                                    "reduced), of a range image with its "
                                    "registered modalities, of an elevation map, of a mesh, of a "
                                    "model, or of a point cloud. The file's content decides what "
                                    "it is: " +
                                        render::range::readableRanges() + "; meshes are " +
                                        render::mesh::readableEndings() + "; point clouds are " +
                                        render::points::readableClouds() +
                                        "; maps and models that the program merlin-import reads in "
                                        "a sandbox are " +
                                        foreignFormats() +
                                        ". Parts of a model become one mesh; the feature label "
                                        "has the number of each vertex' part. Parts that are one "
                                        "surface are welded along their common edges, and several "
                                        "textures become one."
                                        "\nExample: merlin mesh import scan.pgm --geometry "
                                        "orthogonal --angles 60 45 --scale 0.001 "
                                        "--feature colour=photo.ppm --spikes 2% -o scan.mrm");
  command.option("input", options->inputs, "The file").typeName("IN");
  command
      .option("-o", options->output,
              "The result: a model (.mrm), a mesh (.ply, .obj, .glb, .gltf, .stl, .iv), or the "
              "filtered range image (.pgm: without features, and without the options that are for "
              "meshes)")
      .required()
      .typeName("OUT");
  addImportOptions(command, *options);
  addLocal(command, options->local);
  command.flag("--json", options->json, "Print the report as JSON, for programs");
  command.callback([options, &run] {
    run = [options] {
      const auto done = importFile(*options);
      return done ? kExitDone : fail(done.error());
    };
  });
}

}  // namespace merlin::cli
