#include "daemon/cli/mesh/import_range.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "render/mesh/io/feature_names.h"
#include "render/range/colours.h"
#include "render/range/filters.h"
#include "render/range/geometry.h"
#include "render/range/io/plane_file.h"
#include "render/range/map_origin.h"

namespace merlin::cli {
namespace {

namespace range = render::range;

// Default of --max-edge, in steps between pixels: surfaces that are inclined by up to 84 degrees
// stay connected.
constexpr double kSteps = 10;

bool readWhole(std::string_view text, double& value) {
  const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
  return wrong == std::errc() && end == text.data() + text.size();
}

// Parses a length or a percentage of the range: "0.05", "3%".
Result<range::Threshold> thresholdOf(const char* option, std::string_view text) {
  range::Threshold threshold;
  const bool percent = text.ends_with('%');
  double value = 0;
  if (!readWhole(text.substr(0, text.size() - (percent ? 1 : 0)), value) || !(value > 0) ||
      !(value <= 1e9))
    return Error{Errc::kInvalidArgument,
                 fmt::format("{} {}: is neither a length nor a percentage of the range, such as 3%",
                             option, text)};
  (percent ? threshold.per_range : threshold.length) =
      static_cast<float>(percent ? value / 100 : value);
  return threshold;
}

bool isElevation(const range::RangeImage& image) {
  return image.geometry.scanner == range::Scanner::kElevation;
}

Error percentOfHeight(const char* option) {
  return {Errc::kInvalidArgument,
          fmt::format("{}: an elevation map holds heights, not distances from a scanner, so a "
                      "percentage of the range has no meaning; give a length",
                      option)};
}

// Returns why a feature with this name cannot be added, as the end of a message; empty if it can be
// added.
std::string nameFault(const std::string& name, const ImportedRange& loaded) {
  for (const char* taken : {"normal", "texcoord", "border"}) {
    if (name == taken) return fmt::format("the name {} is MERLIN's own", name);
  }
  if (loaded.image.find(name)) return fmt::format("there is a feature {} already", name);
  return render::mesh::featureNameFault(name);
}

// Adds the image that an option --feature NAME=FILE names. `text`: "NAME=FILE". Errors:
// kInvalidArgument, those of readPlane().
Result<Ok> addFeature(const std::string& text, ImportedRange& loaded) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    return Error{Errc::kInvalidArgument, fmt::format("--feature {}: is not NAME=FILE", text)};
  if (const std::string fault = nameFault(name, loaded); !fault.empty())
    return Error{Errc::kInvalidArgument, fmt::format("--feature {}: {}", text, fault)};
  auto plane = range::readPlane(name, text.substr(equals + 1), loaded.image);
  if (!plane) return plane.error();
  loaded.image.planes.push_back(*std::move(plane));
  return Ok{};
}

// Adds the feature images that the range image names, except those that options name. A missing
// image only causes a note, because the range image may have been copied without it.
Result<Ok> addNamedFeatures(const std::string& path, const RangeImport& options, bool texture,
                            const std::vector<range::FeatureFile>& named, ImportedRange& loaded) {
  const std::size_t given = loaded.image.planes.size();
  const auto isGiven = [&](const std::string& name) {
    const auto& planes = loaded.image.planes;
    return std::any_of(planes.begin(), planes.begin() + static_cast<std::ptrdiff_t>(given),
                       [&](const range::Plane& plane) { return plane.name == name; });
  };
  for (const range::FeatureFile& feature : named) {
    if (isGiven(feature.name) || (texture && feature.name == "colour")) continue;
    if (const std::string fault = nameFault(feature.name, loaded); !fault.empty())
      return Error{Errc::kMalformed, fmt::format("{}: feature: {}", path, fault)};
    const std::string file = path.substr(0, path.rfind('/') + 1) + feature.file;
    auto plane = range::readPlane(feature.name, file, loaded.image);
    if (plane) {
      loaded.image.planes.push_back(*std::move(plane));
      continue;
    }
    if (plane.error().code != Errc::kNotFound) return plane.error();
    loaded.notes.push_back(
        fmt::format("{}, the file of the feature {}, does not exist; the feature is left out ({})",
                    file, feature.name, options.otherFileFor(feature.name)));
  }
  return Ok{};
}

// Returns those of `values` (one per pixel) that belong to pixels with a return.
std::vector<float> valuesAtReturns(const range::RangeImage& image, std::span<const float> values) {
  std::vector<float> some;
  for (std::size_t p = 0; p < image.pixels(); ++p) {
    if (range::isReturn(image.range[p])) some.push_back(values[p]);
  }
  return some;
}

// Adds the feature "colour", computed from the feature that --colour-by names. Without the option,
// an image without colours is coloured by its confidence or, if it is an elevation map, by its
// height.
Result<Ok> addColours(const std::string& wanted, bool texture, range::RangeImage& image) {
  const bool coloured = texture || image.find("colour");
  const range::Plane* confidence = image.find("confidence");
  std::string by = wanted;
  if (by.empty() && !coloured)
    by = confidence && confidence->dimension == 1 ? "confidence"
         : isElevation(image)                     ? "height"
                                                  : "";
  if (by.empty() || by == "none") return Ok{};
  if (image.find("colour"))
    return Error{Errc::kInvalidArgument, "--colour-by: there is a feature colour already"};
  const bool heights = by == "height" && isElevation(image);
  const range::Plane* plane = image.find(by);
  if (!heights && (!plane || plane->dimension != 1))
    return Error{
        Errc::kInvalidArgument,
        fmt::format("--colour-by {}: there is no such feature of one value per pixel", by)};
  const std::span<const float> values = heights ? image.range : plane->values;
  const range::Ends ends = !heights && plane->low != plane->high
                               ? range::Ends{plane->low, plane->high}
                               : range::endsOf(valuesAtReturns(image, values));
  const auto scale = heights ? range::Scale::kTerrain : range::Scale::kBlueToRed;
  image.planes.push_back(range::coloursOf(values, ends, scale));
  return Ok{};
}

std::vector<FeatureFacts> factsOfPlanes(const range::RangeImage& image) {
  std::vector<FeatureFacts> facts;
  for (const range::Plane& plane : image.planes) facts.push_back(factsOf(plane, image));
  return facts;
}

// Estimates the peak memory for filters and mesh [bytes]. Planes are in memory twice, as pixels and
// as features of the mesh.
std::size_t memoryFor(const range::RangeImage& image) {
  std::size_t values = 0;
  for (const range::Plane& plane : image.planes) values += plane.dimension;
  return image.pixels() * (80 + 8 * values);
}

Result<Ok> chooseMaxEdge(const RangeImport& options, ImportedRange& range) {
  if (options.max_edge == "none" || (options.max_edge.empty() && isElevation(range.image))) {
    range.max_edge_text = "edges of any length";
    return Ok{};
  }
  if (options.max_edge.empty()) {
    const double step = render::range::stepOf(range.image);
    range.max_edge.per_range = static_cast<float>(kSteps * step);
    range.max_edge_text =
        fmt::format("edges of up to {:.3g} % of the range, {} steps between pixels (--max-edge)",
                    100 * kSteps * step, kSteps);
    return Ok{};
  }
  const auto threshold = thresholdOf("--max-edge", options.max_edge);
  if (!threshold) return threshold.error();
  if (isElevation(range.image) && std::isinf(threshold->length))
    return percentOfHeight("--max-edge");
  range.max_edge = *threshold;
  range.max_edge_text = fmt::format("edges of up to {}{}", options.max_edge,
                                    options.max_edge.ends_with('%') ? " of the range" : "");
  return Ok{};
}

Error nothingLeft(const std::string& path, const std::string& why) {
  return {Errc::kMalformed, fmt::format("{}: {}", path, why)};
}

}  // namespace

Argument RangeImport::keep(const char* name, Argument argument) {
  names_.emplace_back(name);
  arguments_.push_back(argument);
  return argument;
}

void RangeImport::addTo(Command command) {
  addGeometry(command);
  addRaw(command);
  addMaxEdge(command);
  addFilters(command);
  addFeatures(command);
}

void RangeImport::addReadingTo(Command command) {
  addGeometry(command);
  addRaw(command);
  addFilters(command);
}

void RangeImport::addGeometry(Command command) {
  keep("--geometry",
       command.option("--geometry", geometry_,
                      "How the pixels of a range image become rays: orthogonal (two mirrors), "
                      "spinning (a turning head), pinhole (a camera of depths), elevation (a map "
                      "from above); overrides what the file says"))
      .oneOf({"orthogonal", "spinning", "pinhole", "elevation"});
  keep("--angles",
       command.option("--angles", angles_,
                      "Horizontal and vertical angle of the image, in degrees, or a file with the "
                      "angles of the rows (render/range/README.md)"))
      .typeName("H V | FILE")
      .expected(1, 2);
  keep("--cell", command.option("--cell", cell_,
                                "Elevation map: distance of its columns, and of "
                                "its rows if that differs"))
      .typeName("X [Y]")
      .expected(1, 2);
  keep("--exaggerate",
       command.option("--exaggerate", exaggeration_, "Elevation map: factor of the heights"))
      .typeName("FACTOR");
  keep("--no-return", command.option("--no-return", no_return_,
                                     "Stored value of pixels without a return; by default 0 for "
                                     "range images"))
      .typeName("VALUE");
}

void RangeImport::addRaw(Command command) {
  keep("--hdu", command.option("--hdu", hdu,
                               "FITS file: the image to read, by its number (0 is the primary "
                               "one) or its EXTNAME; by default the first of two axes"))
      .typeName("N|NAME");
  keep("--variable",
       command.option("--variable", variable,
                      "File of several maps (netCDF, HDF5, a TIFF file of several images): the one "
                      "to read, by the name of its variable or by its number from 1"))
      .typeName("NAME|N");
  keep("--raw", command.option("--raw", raw_,
                               "The input is raw binary: its size, its planes in their order and "
                               "their types (" +
                                   range::rawTypes() + "); a plane named - is skipped"))
      .typeName("WxH:range=TYPE,NAME=TYPE,...");
  keep("--raw-header",
       command.option("--raw-header", raw_header_, "Raw binary: bytes before the planes"))
      .typeName("BYTES");
  keep("--raw-interleaved",
       command.flag("--raw-interleaved", raw_interleaved_,
                    "Raw binary: the planes' values follow one another pixel by pixel"));
}

void RangeImport::addMaxEdge(Command command) {
  keep("--max-edge",
       command.option(
           "--max-edge", max_edge,
           "Longest edge of a triangle: a length, a percentage of the range, or none for "
           "any; by default 10 times the step between pixels, and any for elevation maps"))
      .typeName("LENGTH|PERCENT%");
}

void RangeImport::addFilters(Command command) {
  keep("--median",
       command.option("--median", median, "Median filter of this width in pixels: 3, 5, ... 15"))
      .check([](const std::string& value) {
        const bool odd = value == "3" || value == "5" || value == "7" || value == "9" ||
                         value == "11" || value == "13" || value == "15";
        return odd ? std::string() : value + " is none of 3, 5, 7, 9, 11, 13, 15";
      });
  keep("--spikes",
       command.option("--spikes", spikes,
                      "Remove pixels that differ by more than this from all but one of their "
                      "neighbours; edges of surfaces stay"))
      .typeName("LENGTH|PERCENT%");
  keep("--between", command.option("--between", between, "Remove returns outside these ranges"))
      .typeName("NEAR FAR")
      .expected(2);
}

void RangeImport::addFeatures(Command command) {
  takes_features_ = true;
  keep(
      "--feature",
      command.option("--feature", features,
                     "A registered image (PGM, PPM, PNG, JPEG) of the same size, which becomes the "
                     "feature NAME of the vertices; may be repeated"))
      .typeName("NAME=FILE")
      .repeatable();
  keep("--colour-by",
       command.option("--colour-by", colour_by,
                      "Compute colours from a feature (high values red, low values blue) or from "
                      "the height of an elevation map; none: no colours. By default from "
                      "confidence or height, where the input has no colours"))
      .typeName("FEATURE");
  keep("--border", command.flag("--border", border,
                                "Add the feature border, 1 at vertices on a border, 0 elsewhere"));
}

std::string RangeImport::anyGiven() const {
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    if (arguments_[i].isGiven()) return names_[i];
  }
  return {};
}

std::string RangeImport::givenForMesh() const {
  constexpr std::string_view kForMesh[] = {"--max-edge", "--exaggerate", "--feature", "--colour-by",
                                           "--border"};
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    if (arguments_[i].isGiven() && std::ranges::find(kForMesh, names_[i]) != std::end(kForMesh))
      return names_[i];
  }
  return {};
}

std::string RangeImport::otherFileFor(const std::string& feature) const {
  return takes_features_ ? fmt::format("--feature {}=FILE", feature)
                         : "put it where the image names it";
}

std::optional<std::string> RangeImport::takeInput() {
  double number = 0;
  if (angles_.size() < 2 || readWhole(angles_.front(), number)) return std::nullopt;
  std::string input = angles_.back();
  angles_.pop_back();
  return input;
}

Result<render::range::RangeOptions> RangeImport::fileOptions() const {
  range::RangeOptions options;
  options.scanner = range::scannerOf(geometry_);
  std::array<double, 2> angles{};
  const bool numbers = !angles_.empty() && readWhole(angles_[0], angles[0]) &&
                       (angles_.size() < 2 || readWhole(angles_[1], angles[1]));
  if (numbers)
    options.angles_deg = angles;
  else if (angles_.size() == 1)
    options.angle_table = angles_[0];
  else if (angles_.size() == 2)
    return Error{Errc::kInvalidArgument, fmt::format("--angles {} {}: are not two numbers, nor one "
                                                     "file",
                                                     angles_[0], angles_[1])};
  if (!cell_.empty()) options.cell = {cell_.front(), cell_.back()};
  options.exaggeration = exaggeration_;
  options.no_return = no_return_;
  options.scale = scale;
  if (!raw_.empty() && !hdu.empty())
    return Error{Errc::kInvalidArgument, "--hdu is for FITS files, --raw for others"};
  if (!raw_.empty() && !variable.empty())
    return Error{Errc::kInvalidArgument,
                 "--variable is for netCDF and other files of maps, --raw for others"};
  if (raw_.empty() && (raw_header_ > 0 || raw_interleaved_))
    return Error{Errc::kInvalidArgument, "--raw-header and --raw-interleaved need --raw"};
  if (raw_.empty()) return options;
  auto layout = range::parseRawLayout(raw_);
  if (!layout) return Error{layout.error().code, "--raw " + layout.error().what};
  for (const auto& plane : layout->planes) {
    const std::string fault = plane.name == "-" ? "" : render::mesh::featureNameFault(plane.name);
    if (!fault.empty())
      return Error{Errc::kInvalidArgument, fmt::format("--raw {}: {}", raw_, fault)};
  }
  layout->header_bytes = raw_header_;
  layout->interleaved = raw_interleaved_;
  options.raw = *std::move(layout);
  return options;
}

Result<ImportedRange> loadRange(const std::string& path, const RangeImport& options, bool texture,
                                const RangeReader& read) {
  const auto file_options = options.fileOptions();
  if (!file_options) return file_options.error();
  auto loaded = read(path, *file_options);
  if (!loaded) return loaded.error();
  ImportedRange imported;
  imported.image = std::move(loaded->image);
  imported.format = std::move(loaded->format);
  imported.notes = std::move(loaded->notes);
  imported.in_metres = loaded->in_metres;
  if (!imported.in_metres)
    imported.notes.emplace_back(
        "the file does not say in which unit its ranges are, so they are used unchanged; --scale "
        "METRES_PER_UNIT converts them to metres");
  imported.returns_in_file = static_cast<std::size_t>(
      std::count_if(imported.image.range.begin(), imported.image.range.end(), range::isReturn));
  imported.image.join_ends = !texture;
  for (const std::string& text : options.features) {
    if (const auto added = addFeature(text, imported); !added) return added.error();
  }
  const auto added = addNamedFeatures(path, options, texture, loaded->features, imported);
  if (!added) return added.error();
  return imported;
}

Result<Ok> filterRange(const std::string& path, const RangeImport& options, std::size_t limit,
                       const range::Work& work, ImportedRange& imported) {
  range::RangeImage& image = imported.image;
  if (memoryFor(image) > limit)
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: {} x {} pixels take {} MB as a mesh; the limit (--memory, by "
                             "default the free memory) is {} MB",
                             path, image.width, image.height, memoryFor(image) >> 20, limit >> 20)};
  if (!options.between.empty())
    imported.outside = range::removeOutside(image, static_cast<float>(options.between[0]),
                                            static_cast<float>(options.between[1]));
  if (!options.spikes.empty()) {
    const auto threshold = thresholdOf("--spikes", options.spikes);
    if (!threshold) return threshold.error();
    if (isElevation(image) && std::isinf(threshold->length)) return percentOfHeight("--spikes");
    imported.spikes = range::removeSpikes(image, *threshold, range::partOf(work, 0, 0.4));
  }
  if (options.median > 0) range::medianFilter(image, options.median, range::partOf(work, 0.4, 1));
  if (std::none_of(image.range.begin(), image.range.end(), range::isReturn))
    return nothingLeft(
        path, fmt::format("the filters removed all of its {} returns", imported.returns_in_file));
  return Ok{};
}

void subtract(const render::mesh::Origin& origin, range::Geometry& geometry) {
  for (std::size_t k = 0; k < 3; ++k) geometry.T_world_scanner[4 * k + 3] -= origin[k];
}

render::mesh::Origin takeOrigin(range::Geometry& geometry) {
  const range::Pose& pose = geometry.T_world_scanner;
  const render::mesh::Origin origin = render::mesh::originNear({pose[3], pose[7], pose[11]});
  subtract(origin, geometry);
  return origin;
}

Result<Ok> meshRange(const std::string& path, const RangeImport& options, const range::Work& work,
                     ImportedRange& imported) {
  range::RangeImage& image = imported.image;
  if (const auto chosen = chooseMaxEdge(options, imported); !chosen) return chosen;
  if (const auto added = addColours(options.colour_by, !image.join_ends, image); !added)
    return added;
  imported.features = factsOfPlanes(image);
  imported.origin =
      isElevation(image) ? range::mapOrigin(image.geometry) : takeOrigin(image.geometry);
  const std::vector<float> points = range::pointsOf(image, range::partOf(work, 0, 0.2));
  imported.mesh = range::triangulate(image, points, imported.max_edge, range::partOf(work, 0.2, 1));
  range::RangeMesh& mesh = imported.mesh;
  if (mesh.mesh.triangles.empty())
    return nothingLeft(path, fmt::format("its {} returns make no triangle with {}", mesh.returns,
                                         imported.max_edge_text));
  if (!image.join_ends) range::addTexcoords(mesh, image);
  if (options.border)
    mesh.mesh.features.push_back({"border", 1, {mesh.on_boundary.begin(), mesh.on_boundary.end()}});
  return Ok{};
}

}  // namespace merlin::cli
