// merlin mesh scan: computes the range image that a scanner would take of a model.
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/process_memory.h"
#include "daemon/base/radian.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/about_text.h"
#include "daemon/cli/mesh/import_model.h"
#include "daemon/cli/mesh/input_kinds.h"
#include "daemon/cli/mesh/late_bar.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/print.h"
#include "render/lod/io/mrm_file.h"
#include "render/mesh/io/companion_files.h"
#include "render/points/io/cloud_file.h"
#include "render/range/colours.h"
#include "render/range/geometry.h"
#include "render/range/io/plane_file.h"
#include "render/range/io/range_file.h"
#include "render/scan/placement.h"
#include "render/scan/scan.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

namespace range = render::range;
namespace scan = render::scan;

struct MeshScan {
  std::string model, output, geometry = "orthogonal";
  std::vector<double> angles_deg = {40, 30}, camera;
  double yaw_deg = 0, pitch_deg = 0, drop_outs_percent = 0, most_incidence_deg = 90;
  scan::ScanSettings settings;
  unsigned threads = 0;
  bool json = false;
};

// Facts about the files that were written.
struct ScannedFiles {
  std::vector<range::FeatureFile> features;  // feature images beside the output
  std::vector<std::string> left_out;
  range::Ends ends;       // the nearest and the farthest range
  double range_step = 0;  // step between stored ranges; 0: they are stored as floats
  double angle_step = 0;
};

// The mesh that is scanned, and the facts in its file.
struct Model {
  render::mesh::Mesh mesh;
  // Origin of the file's coordinates. --camera and the written camera transform are in these
  // coordinates.
  render::mesh::Origin origin{};
  std::string about;  // the text "about" of a model (.mrm)
  std::string unit;   // of the coordinates; empty: not known
};

// Reads any file except a range image that merlin mesh import can convert to a mesh without further
// options.
Result<Model> readByContent(const MeshScan& options) {
  const std::string& path = options.model;
  if (const auto there = checkIsThere(path); !there) return there.error();
  const auto kind = inputKindOf(path);
  if (!kind)
    return Error{
        Errc::kUnsupported,
        fmt::format("{}: has no mesh format that MERLIN reads; supported are .mrm, {}, {}, {}",
                    path, render::mesh::readableEndings(), render::points::readableClouds(),
                    foreignFormats())};
  if (kind->isGrid())
    return Error{Errc::kUnsupported,
                 fmt::format("{0}: is a range image or a map already; merlin mesh import {0} -o "
                             "OUT.ply makes a mesh of it, which can be scanned",
                             path)};
  auto model = loadModel(path, *kind, {options.output, freeMemory()});
  if (!model) return model.error();
  return Model{std::move(model->loaded.mesh),
               model->cloud ? model->cloud->origin : model->loaded.origin,
               {},
               kind->unit()};
}

// Reads a model (.mrm) or any other file. The coordinates of a model are used as they are, even if
// an origin was subtracted from them when the model was made.
Result<Model> readModel(const MeshScan& options) {
  if (!options.model.ends_with(".mrm")) return readByContent(options);
  const auto model = render::lod::readMrm(options.model);
  if (!model) return model.error();
  const std::string about = model->arrays().about;
  return Model{render::lod::extract(*model, 0), {}, about, valueIn(about, "unit")};
}

// Returns the pose of the scanner relative to `origin`, by --camera or, without it, by --yaw and
// --pitch around the bounding box. Errors: kInvalidArgument.
Result<range::Pose> poseOf(const MeshScan& options, const render::mesh::Box& box,
                           const render::mesh::Origin& origin) {
  const std::vector<double>& c = options.camera;
  if (c.empty())
    return scan::around(box, options.yaw_deg * kRadian<double>, options.pitch_deg * kRadian<double>,
                        options.settings.geometry);
  if (c.size() == 12) {
    range::Pose pose;
    std::copy(c.begin(), c.end(), pose.begin());
    for (std::size_t k = 0; k < 3; ++k) pose[4 * k + 3] -= origin[k];
    return pose;
  }
  if (c.size() != 3 && c.size() != 6)
    return Error{Errc::kInvalidArgument,
                 fmt::format("--camera: {} numbers are given; allowed are 3 (the scanner's place), "
                             "6 (and a point that it looks at) and 12 (a transform)",
                             c.size())};
  const auto relative = [&](std::size_t at) {
    return scan::Point{c[at] - origin[0], c[at + 1] - origin[1], c[at + 2] - origin[2]};
  };
  const scan::Point from = relative(0);
  const scan::Point at = c.size() == 6 ? relative(3) : scan::centreOf(box);
  if (from == at)
    return Error{Errc::kInvalidArgument,
                 "--camera: the scanner's place and the point that it looks at are the same"};
  return scan::lookAt(from, at);
}

Result<Ok> place(MeshScan& options, const Model& model) {
  range::Geometry& geometry = options.settings.geometry;
  geometry.scanner = *range::scannerOf(options.geometry);
  geometry.horizontal_rad = options.angles_deg[0] * kRadian<double>;
  geometry.vertical_rad = options.angles_deg[1] * kRadian<double>;
  const auto pose = poseOf(options, render::mesh::boundingBox(model.mesh.positions), model.origin);
  if (!pose) return pose.error();
  geometry.T_world_scanner = *pose;
  if (geometry.scanner != range::Scanner::kSpinning) return Ok{};
  geometry.beams = range::evenBeams(geometry.vertical_rad, options.settings.height);
  geometry.vertical_rad = 0;
  return Ok{};
}

Error nothingMet(const MeshScan& options, const Model& model, const std::string& what) {
  const render::mesh::Box box = render::mesh::boundingBox(model.mesh.positions);
  const auto corner = [&](const std::array<float, 3>& p) {
    const auto& o = model.origin;
    return fmt::format("({:.10g}, {:.10g}, {:.10g})", p[0] + o[0], p[1] + o[1], p[2] + o[2]);
  };
  return {Errc::kInvalidArgument,
          fmt::format("{}: {}; the model lies between {} and {}: leave --camera out, or look there",
                      options.model, what, corner(box.low), corner(box.high))};
}

// Sets unit and range of the planes to those that the model states for their features.
void addFacts(const Model& model, range::RangeImage& image) {
  for (range::Plane& plane : image.planes) {
    if (plane.dimension != 1 || plane.name == "confidence") continue;
    const FeatureFacts facts = featureIn(model.about, plane.name);
    plane.unit = facts.unit;
    plane.low = facts.low;
    plane.high = facts.high;
  }
}

// Scans the model and returns the range image, whose camera transform is in the coordinates of the
// model's file.
Result<scan::Scan> scanModel(MeshScan& options) {
  const auto model = readModel(options);
  if (!model) return model.error();
  const render::mesh::Mesh& mesh = model->mesh;
  const auto named = [&](const Error& error) {
    return Error{error.code, options.model + ": " + error.what};
  };
  if (const auto placed = place(options, *model); !placed) return placed.error();
  std::optional<render::image::ImageFile> texture;
  const render::mesh::Feature* texcoord = mesh.find("texcoord");
  if (!mesh.texture.empty() && texcoord && texcoord->dimension == 2) {
    auto decoded = render::image::decodeImage(mesh.texture);
    if (!decoded) return named({decoded.error().code, "its texture: " + decoded.error().what});
    texture = *std::move(decoded);
  }
  const SystemClock clock;
  LateBar bar("scanning", options.settings.width * options.settings.height, clock);
  auto scanned = scan::scan({mesh, texture ? &*texture : nullptr}, options.settings,
                            bar.work(options.threads));
  if (!scanned && scanned.error().code == Errc::kMalformed)
    return nothingMet(options, *model, scanned.error().what);
  if (!scanned) return named(scanned.error());
  bar.finish();
  if (scanned->met == scanned->oblique + scanned->lost)
    return named({Errc::kInvalidArgument,
                  "all of its returns were lost (--drop-outs, "
                  "--max-incidence, --noise)"});
  addFacts(*model, scanned->image);
  scanned->image.unit = model->unit;
  for (std::size_t k = 0; k < 3; ++k)
    scanned->image.geometry.T_world_scanner[4 * k + 3] += model->origin[k];
  return scanned;
}

// Writes the planes as files beside the output, then the output, which contains the names of these
// files.
Result<ScannedFiles> writeScan(const MeshScan& options, const scan::Scan& scanned) {
  ScannedFiles files;
  files.left_out = scanned.left_out;
  const range::RangeImage& image = scanned.image;
  const std::string folder = render::mesh::folderOf(options.output);
  const std::string stem =
      render::mesh::plainName(options.output.substr(0, options.output.rfind('.')));
  for (const range::Plane& plane : image.planes) {
    if (render::mesh::plainName(plane.name) != plane.name || plane.name.empty()) {
      // The name of the plane cannot be a part of a file name.
      files.left_out.push_back(plane.name);
      continue;
    }
    const std::string file = fmt::format("{}.{}{}", stem, plane.name, range::endingOf(plane));
    const auto written = range::writePlane(folder + file, plane, image);
    if (!written) return written.error();
    files.features.push_back({plane.name, file});
  }
  const auto written = range::writeRange(options.output, image, files.features);
  if (!written) return written.error();
  files.ends = range::endsOf(image.range);
  if (!range::isFitsName(options.output))
    files.range_step = (double{files.ends.high} - files.ends.low) / 65534;
  files.angle_step = range::stepOf(image);
  return files;
}

void reportJson(const MeshScan& options, const scan::Scan& scanned, const ScannedFiles& files) {
  Json features = Json::array();
  for (const range::FeatureFile& f : files.features)
    features.push_back({{"name", f.name}, {"file", f.file}});
  const range::RangeImage& image = scanned.image;
  printJsonLine(Json{{"model", options.model},
                     {"output", options.output},
                     {"geometry", range::nameOf(image.geometry.scanner)},
                     {"width", image.width},
                     {"height", image.height},
                     {"returns", scanned.met - scanned.oblique - scanned.lost},
                     {"too_oblique", scanned.oblique},
                     {"dropped", scanned.lost},
                     {"range", {files.ends.low, files.ends.high}},
                     {"range_step", files.range_step},
                     {"angle_step_deg", files.angle_step / kRadian<double>},
                     {"camera", image.geometry.T_world_scanner},
                     {"features", features},
                     {"left_out", files.left_out}});
}

void report(const MeshScan& options, const scan::Scan& scanned, const ScannedFiles& files) {
  if (options.json) return reportJson(options, scanned, files);
  const range::RangeImage& image = scanned.image;
  const range::Pose& pose = image.geometry.T_world_scanner;
  printOut("{}: {} x {} pixels, {} with a return, {}\n", options.output, image.width, image.height,
           scanned.met - scanned.oblique - scanned.lost, range::nameOf(image.geometry.scanner));
  printOut(
      "  scanner   at {:.10g} {:.10g} {:.10g}, {:.6g} degrees between pixels, which is {:.4g} at "
      "the farthest range\n",
      pose[3], pose[7], pose[11], files.angle_step / kRadian<double>,
      files.angle_step * double{files.ends.high});
  printOut("  ranges    {:.6g} to {:.6g}, stored {}\n", files.ends.low, files.ends.high,
           range::isFitsName(options.output) ? "as floats"
                                             : fmt::format("in steps of {:.3g}", files.range_step));
  if (scanned.oblique + scanned.lost > 0)
    printOut("  lost      {} returns of surfaces too oblique, {} dropped\n", scanned.oblique,
             scanned.lost);
  for (const range::FeatureFile& f : files.features)
    printOut("  feature   {}: {}\n", f.name, render::mesh::folderOf(options.output) + f.file);
  for (const std::string& name : files.left_out)
    printOut("  left out  feature {}: not one value per pixel, or its name is taken\n", name);
}

Result<Ok> checkScan(MeshScan& options) {
  if (!range::isFitsName(options.output) && !options.output.ends_with(".pgm"))
    return Error{Errc::kInvalidArgument,
                 options.output + ": the name of a range image must end in .pgm or .fits"};
  if (const auto free = checkOutputs(options.model, {options.output}); !free) return free;
  options.settings.drop_outs = options.drop_outs_percent / 100;
  options.settings.most_incidence_rad = options.most_incidence_deg * kRadian<double>;
  return Ok{};
}

int scanFile(MeshScan& options) {
  if (const auto good = checkScan(options); !good) return fail(good.error());
  const auto scanned = scanModel(options);
  if (!scanned) return fail(scanned.error());
  const auto files = writeScan(options, *scanned);
  if (!files) return fail(files.error());
  report(options, *scanned, *files);
  return kExitDone;
}

void addScanner(Command command, MeshScan& options) {
  command
      .option("--geometry", options.geometry,
              "How pixels become rays: orthogonal (two mirrors), spinning (a turning head), "
              "pinhole (a camera of depths)")
      .oneOf({"orthogonal", "spinning", "pinhole"})
      .showDefault();
  command.option("--angles", options.angles_deg, "Horizontal and vertical angle, in degrees")
      .typeName("H V")
      .expected(2)
      .showDefault();
  command.option("--width", options.settings.width, "Width of the image in pixels")
      .range(std::size_t{2}, std::size_t{16384})
      .showDefault();
  command.option("--height", options.settings.height, "Height of the image in pixels")
      .range(std::size_t{2}, std::size_t{16384})
      .showDefault();
  const Argument camera =
      command
          .option("--camera", options.camera,
                  "Where the scanner stands: its place, looking at the model's centre; its "
                  "place and a point that it looks at; or the transform of the key camera "
                  "(render/range/io/README.md), in the coordinates of the model's file. By default "
                  "far enough to see all of the model")
          .typeName("X Y Z [X Y Z]|12 NUMBERS")
          .expected(3, 12);
  Command turn = command.group(
      "turn",
      "Turns the model in front of a scanner that is placed automatically, without --camera");
  turn.option("--yaw", options.yaw_deg, "Rotation about the vertical axis, in degrees")
      .showDefault();
  turn.option("--pitch", options.pitch_deg,
              "Rotation about the horizontal axis, in degrees, applied before the yaw; -90 for a "
              "model whose z axis points up")
      .showDefault();
  turn.exclude(camera);
}

void addFaults(Command command, MeshScan& options) {
  command
      .option("--noise", options.settings.noise,
              "Standard deviation of the ranges, in the model's units")
      .nonNegative()
      .showDefault();
  command
      .option("--drop-outs", options.drop_outs_percent,
              "Share of the returns that are lost, in percent")
      .range(0.0, 100.0)
      .showDefault();
  command
      .option("--max-incidence", options.most_incidence_deg,
              "Largest angle between the ray and a surface's normal, in degrees, at which the "
              "surface gives a return")
      .range(1.0, 90.0)
      .showDefault();
  command
      .option(
          "--seed", options.settings.seed,
          "Seed of the random numbers for noise and drop-outs: the same seed gives the same files")
      .showDefault();
}

}  // namespace

void addMeshScan(Command mesh, Run& run) {
  const auto options = std::make_shared<MeshScan>();
  Command command = mesh.subcommand(
      "scan",
      "Take a range image of a model with a simulated scanner, by casting a ray for each pixel. "
      "The features of the model (colours, labels, any other of one value) and the confidence (the "
      "cosine of the angle of incidence) become images beside OUT, which names them, so that "
      "merlin mesh import OUT reads everything back.\nExample: merlin mesh scan bust.ply --yaw "
      "30 --noise 0.0005 --drop-outs 1 -o scan.pgm");
  command
      .option("model", options->model,
              "The model (.mrm), or whatever merlin mesh import makes a mesh of: a mesh (" +
                  render::mesh::readableEndings() +
                  "), a point cloud, a model of another program (through merlin-import)")
      .required()
      .typeName("MODEL");
  command
      .option(
          "-o", options->output,
          "The range image: PGM of 16 bits, or FITS of floats, whose ranges are exact. The images "
          "beside it are OUT.NAME.pgm and OUT.NAME.png, and replace existing files of these names")
      .required()
      .typeName("OUT.pgm|OUT.fits");
  addScanner(command, *options);
  addFaults(command, *options);
  command
      .option("--threads", options->threads,
              "Maximum number of threads; 0: all cores. The result does not depend on this number")
      .showDefault();
  command.flag("--json", options->json, "Print the report as JSON, for programs");
  command.callback([options, &run] { run = [options] { return scanFile(*options); }; });
}

}  // namespace merlin::cli
