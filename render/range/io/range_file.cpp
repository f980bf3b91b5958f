#include "render/range/io/range_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/base/huge_vector.h"
#include "render/range/geometry.h"
#include "render/range/io/angle_table.h"
#include "render/range/io/elevation.h"
#include "render/range/io/fits_write.h"
#include "render/range/io/grid_file.h"
#include "render/range/io/netpbm.h"
#include "render/range/io/pcd.h"
#include "render/range/io/range_grid.h"
#include "render/range/io/words.h"

namespace merlin::render::range {
namespace {

std::string nameIn(const std::string& path) { return path.substr(path.rfind('/') + 1); }

// Returns whether the file is a PGM. A PPM is a picture, not a range image.
bool isPgm(std::string_view bytes, std::string_view) {
  return isNetpbm(bytes) && (bytes[1] == '2' || bytes[1] == '5');
}

// Returns the text of the file FILE.prj in the same folder as FILE.asc; empty if there is none.
std::string projectionBeside(const std::string& path) {
  constexpr std::size_t kMost = 4096;
  const std::size_t dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] != '.') return {};
  const auto file = FileCopy::read(path.substr(0, dot) + ".prj", kMost);
  return file ? std::string(file->text()) : std::string();
}

struct RangeFormat {
  const char* name;
  bool (*is)(std::string_view bytes, std::string_view name);
  Result<StoredImage> (*read)(std::string_view bytes, const std::string& path);
};

// Formats that store ranges or heights. Formats of points are handled by separate functions below.
constexpr RangeFormat kFormats[] = {
    {"PGM", isPgm, [](std::string_view bytes, const std::string&) { return parseNetpbm(bytes); }},
    {"ESRI ASCII grid", [](std::string_view bytes, std::string_view) { return isEsriGrid(bytes); },
     [](std::string_view bytes, const std::string& path) {
       return parseEsriGrid(bytes, projectionBeside(path));
     }},
    {"HGT", isHgt, [](std::string_view bytes, const std::string& path) {
       return parseHgt(bytes, nameIn(path));
     }}};

const RangeFormat* formatOf(std::string_view bytes, std::string_view name) {
  for (const RangeFormat& format : kFormats) {
    if (format.is(bytes, name)) return &format;
  }
  return nullptr;
}

Result<Ok> readTable(const RangeOptions& options, ImageHeader& header) {
  constexpr std::size_t kMost = std::size_t{16} << 20;
  if (options.angle_table.empty()) return Ok{};
  const auto file = FileCopy::read(options.angle_table, kMost);
  if (!file) return file.error();
  const auto parsed = parseAngleTable(file->text(), header);
  if (!parsed) return Error{parsed.error().code, options.angle_table + ": " + parsed.error().what};
  return Ok{};
}

// Overrides values of the file's header by the caller's options.
Result<Ok> overrideHeader(const RangeOptions& options, ImageHeader& header) {
  if (const auto read = readTable(options, header); !read) return read;
  if (!options.angle_table.empty() && options.scanner && *options.scanner != Scanner::kSpinning)
    return Error{Errc::kInvalidArgument,
                 options.angle_table + ": a table of angles is for --geometry spinning"};
  if (options.scanner) header.scanner = options.scanner;
  if (options.angles_deg) header.angles_deg = options.angles_deg;
  if (options.scale) header.scale = options.scale;
  if (options.cell) header.cell = options.cell;
  if (options.no_return) header.no_return = options.no_return;
  return Ok{};
}

Geometry geometryOf(const ImageHeader& header, const RangeOptions& options, std::size_t rows) {
  Geometry g;
  g.scanner = header.scanner.value_or(Scanner::kOrthogonal);
  if (header.angles_deg) {
    g.horizontal_rad = (*header.angles_deg)[0] * kDegree;
    g.vertical_rad = (*header.angles_deg)[1] * kDegree;
  }
  if (g.scanner == Scanner::kSpinning) {
    g.beams = header.beams;
    if (g.beams.empty() && g.vertical_rad > 0) g.beams = evenBeams(g.vertical_rad, rows);
    g.vertical_rad = 0;
  }
  if (g.scanner == Scanner::kElevation) {
    const auto cell = header.cell.value_or(std::array<double, 2>{0, 0});
    g.cell_x = cell[0];
    g.cell_y = cell[1];
    g.exaggeration = options.exaggeration.value_or(1);
    g.projection = header.projection;
    g.origin = header.origin;
  } else if (header.camera) {
    g.T_world_scanner = *header.camera;
  }
  return g;
}

// Converts stored values to ranges, by the header's scale; values that mean no return become
// kNoReturn.
void setRanges(const StoredImage& stored, RangeImage& image) {
  const ImageHeader& header = stored.header;
  const bool elevation = image.geometry.scanner == Scanner::kElevation;
  const bool scaled = header.minimum && header.maximum && stored.largest > 0;
  const double scale = header.scale.value_or(1);
  const double first = scaled ? *header.minimum * scale : 0;
  const double step = scaled ? (*header.maximum - *header.minimum) / stored.largest * scale : scale;
  const auto none = static_cast<float>(
      header.no_return.value_or(elevation ? std::numeric_limits<double>::quiet_NaN() : 0));
  resizeHuge(image.range, stored.values.size());
  for (std::size_t p = 0; p < stored.values.size(); ++p) {
    const float value = stored.values[p];
    const auto range = static_cast<float>(first + double{value} * step);
    const bool far = !(std::abs(range) <= kFarthest);  // true for NaN
    image.range[p] = value == none || far || (!elevation && !(range > 0)) ? kNoReturn : range;
  }
}

std::string elevationOnly(const RangeOptions& options, Scanner scanner) {
  if (scanner == Scanner::kElevation) {
    if (options.angles_deg || !options.angle_table.empty())
      return "is an elevation map, which has no angles; leave --angles out";
    return {};
  }
  if (options.cell) return "--cell is for elevation maps (--geometry elevation)";
  if (options.exaggeration) return "--exaggerate is for elevation maps (--geometry elevation)";
  return {};
}

bool isInMetres(const ImageHeader& header) {
  if (!header.unit.empty() && !header.scale && header.scanner != Scanner::kElevation)
    return header.unit == "m";
  return header.scale || (header.minimum && header.maximum) || header.unit == "m" ||
         header.scanner == Scanner::kElevation;
}

Result<LoadedRange> loadStored(StoredImage stored, const RangeOptions& options) {
  if (const auto set = overrideHeader(options, stored.header); !set) return set.error();
  LoadedRange loaded;
  RangeImage& image = loaded.image;
  image.width = stored.width;
  image.height = stored.height;
  image.geometry = geometryOf(stored.header, options, stored.height);
  if (const std::string fault = elevationOnly(options, image.geometry.scanner); !fault.empty())
    return Error{Errc::kInvalidArgument, fault};
  if (image.geometry.scanner == Scanner::kElevation && !stored.header.cell)
    return Error{Errc::kInvalidArgument,
                 "the distance of its heights is not known; give it with "
                 "--cell METRES [METRES]"};
  if (stored.header.columns && *stored.header.columns != stored.width)
    return Error{Errc::kInvalidArgument,
                 fmt::format("the table of angles is for {} columns, the image has {}",
                             *stored.header.columns, stored.width)};
  setRanges(stored, image);
  loaded.in_metres = isInMetres(stored.header);
  image.unit = loaded.in_metres ? "m" : "";
  image.planes = std::move(stored.planes);
  loaded.features = std::move(stored.header.features);
  loaded.notes = std::move(stored.notes);
  return loaded;
}

bool hasPoints(std::string_view bytes) { return isPcd(bytes) || isRangeGrid(bytes); }

Result<LoadedRange> parsePoints(std::string_view bytes) {
  LoadedRange loaded;
  const auto take = [&](auto parsed, const char* format) -> Result<LoadedRange> {
    if (!parsed) return parsed.error();
    loaded.image = std::move(parsed->image);
    loaded.format = format;
    loaded.notes = std::move(parsed->notes);
    return std::move(loaded);
  };
  return isPcd(bytes) ? take(parsePcd(bytes), "PCD")
                      : take(parseRangeGrid(bytes), "PLY with a range_grid");
}

Result<LoadedRange> loadPoints(std::string_view bytes, const RangeOptions& options) {
  if (options.scanner || options.angles_deg || !options.angle_table.empty() || options.cell ||
      options.exaggeration || options.no_return)
    return Error{
        Errc::kInvalidArgument,
        "its points have coordinates; leave --geometry, --angles, --cell, --exaggerate and "
        "--no-return out"};
  auto loaded = parsePoints(bytes);
  if (!loaded) return loaded;
  loaded->in_metres = options.scale.has_value();
  const double scale = options.scale.value_or(1);
  for (float& range : loaded->image.range) range = static_cast<float>(range * scale);
  for (const std::size_t k : {3U, 7U, 11U}) loaded->image.geometry.T_world_scanner[k] *= scale;
  return loaded;
}

Result<LoadedRange> load(const std::string& path, const RangeOptions& options) {
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  const auto whole = file->bytes();
  const std::string_view bytes =  // a raw file may begin with any bytes
      options.raw ? std::string_view(reinterpret_cast<const char*>(whole.data()), whole.size())
                  : file->text();
  if (!options.raw && hasPoints(bytes)) return loadPoints(bytes, options);
  const RangeFormat* format = options.raw ? nullptr : formatOf(bytes, nameIn(path));
  if (!options.raw && !format)
    return Error{Errc::kUnsupported, "is not a range image; supported are " + readableRanges()};
  auto stored = options.raw ? parseRaw(bytes, *options.raw) : format->read(bytes, path);
  if (!stored) return stored.error();
  auto loaded = loadStored(*std::move(stored), options);
  if (loaded) loaded->format = options.raw ? "raw binary" : format->name;
  return loaded;
}

Result<LoadedRange> loadGrid(const std::string& path, const RangeOptions& options) {
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  auto grid = parseGrid(file->text());
  if (!grid) return grid.error();
  auto loaded = loadStored(std::move(grid->image), options);
  if (loaded) loaded->format = std::move(grid->format);
  return loaded;
}

std::string emptyFault(const RangeImage& image) {
  if (std::any_of(image.range.begin(), image.range.end(), isReturn)) return {};
  return fmt::format(
      "none of its {} x {} pixels has a return: each is the value that means no return "
      "(--no-return), is not a number, is not positive, or is beyond {:g}",
      image.width, image.height, kFarthest);
}

// Returns `loaded` if points can be computed from it; otherwise an error that names the file.
Result<LoadedRange> checked(const std::string& path, const RangeOptions& options,
                            Result<LoadedRange> loaded) {
  // Errors of the file system and of the table of angles already name their file.
  const auto named = [&](const Error& error) {
    const bool has_name =
        error.what.starts_with(path + ":") ||
        (!options.angle_table.empty() && error.what.starts_with(options.angle_table + ":"));
    return has_name ? error : Error{error.code, path + ": " + error.what};
  };
  if (!loaded) return named(loaded.error());
  const RangeImage& image = loaded->image;
  if (const std::string fault = faultOf(image); !fault.empty())
    return named({Errc::kInvalidArgument, fault});
  if (const std::string fault = emptyFault(image); !fault.empty())
    return named({Errc::kMalformed, fault});
  return loaded;
}
}  // namespace

bool isRangeFile(const std::string& path) {
  const auto file = MappedFile::open(path);
  return file && (hasPoints(file->text()) || formatOf(file->text(), nameIn(path)));
}

std::string readableRanges() {
  return "PGM, organised PCD, PLY with a range_grid, HGT, ESRI ASCII grids and raw binary (--raw)";
}

Result<LoadedRange> readRange(const std::string& path, const RangeOptions& options) {
  return checked(path, options, load(path, options));
}

Result<LoadedRange> readGrid(const std::string& path, const std::string& name,
                             const RangeOptions& options) {
  return checked(name, options, loadGrid(path, options));
}

bool isFitsName(const std::string& path) { return lowerCase(path).ends_with(".fits"); }

Result<Ok> writeRange(const std::string& path, const RangeImage& image,
                      const std::vector<FeatureFile>& features) {
  const Scanner scanner = image.geometry.scanner;
  const bool fits = isFitsName(path);
  if (scanner == Scanner::kRays || (fits && scanner == Scanner::kElevation))
    return Error{Errc::kUnsupported,
                 fmt::format("{}: an image of {} is not written as {}, which has no place for its "
                             "geometry",
                             path, nameOf(scanner), fits ? "FITS" : "PGM")};
  return writeFile(path, [&](const WriteBytes& write) {
    return fits ? writeFits(image, write, features) : writePgm(image, 16, write, features);
  });
}

}  // namespace merlin::render::range
