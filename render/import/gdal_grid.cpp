#include "render/import/gdal_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include "daemon/base/printable_text.h"
#include "daemon/base/words.h"
#include "render/range/range_image.h"

namespace merlin::render::import {
namespace {

// Readers that are not allowed, because they open other files or addresses that a file names.
constexpr std::string_view kNotAllowed[] = {
    "VRT",        "WMS",           "WCS",       "WMTS",         "HTTP",     "DAAS",
    "EEDA",       "EEDAI",         "NGW",       "OGCAPI",       "PLMOSAIC", "PLSCENES",
    "STACTA",     "STACIT",        "MRF",       "TileDB",       "Zarr",     "MBTiles",
    "Rasterlite", "PDF",           "DERIVED",   "RDA",          "GPKG",     "KMLSUPEROVERLAY",
    "CAD",        "PostGISRaster", "GeoRaster", "MSSQLSpatial", "BAG",      "SAFE",
    "SENTINEL2",  "ECRGTOC",       "RPFTOC",    "NITF",         "GMT",      "FITS",
    "MEM",        "ISIS3",         "PDS4",      "GTI"};

bool isAllowed(GDALDriverH driver) {
  const char* raster = GDALGetMetadataItem(driver, GDAL_DCAP_RASTER, nullptr);
  const std::string_view name = GDALGetDriverShortName(driver);
  return raster && std::ranges::find(kNotAllowed, name) == std::end(kNotAllowed);
}

std::string gdalsWords() {
  const std::string words = oneLine(CPLGetLastErrorMsg());
  CPLErrorReset();
  return words.empty() ? "GDAL gives no reason" : words.substr(0, 500);
}

struct CloseDataset {
  void operator()(void* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;

std::string projectionOf(OGRSpatialReferenceH reference) {
  char* text = nullptr;
  std::string wkt;
  if (OSRExportToWkt(reference, &text) == OGRERR_NONE && text) wkt = oneLine(text);
  CPLFree(text);
  return wkt;
}

// Returns the length of a unit of height in metres; nothing if the unit's name is unknown.
std::optional<double> metresOf(std::string_view unit) {
  constexpr std::pair<const char*, double> kUnits[] = {{"", 1},
                                                       {"m", 1},
                                                       {"metre", 1},
                                                       {"meter", 1},
                                                       {"metres", 1},
                                                       {"meters", 1},
                                                       {"ft", 0.3048},
                                                       {"foot", 0.3048},
                                                       {"feet", 0.3048},
                                                       {"cm", 0.01},
                                                       {"dm", 0.1},
                                                       {"km", 1000},
                                                       {"mm", 0.001},
                                                       {"us survey foot", 1200.0 / 3937},
                                                       {"us-ft", 1200.0 / 3937}};
  const std::string name = lowerCase(trimmed(unit));
  for (const auto& [known, metres] : kUnits) {
    if (name == known) return metres;
  }
  return std::nullopt;
}

class GdalGrid final : public GridSource {
 public:
  explicit GdalGrid(Dataset dataset) : dataset_(std::move(dataset)) {}

  Result<Ok> prepare() {
    const int bands = GDALGetRasterCount(dataset_.get());
    const std::string format = oneLine(GDALGetDriverLongName(GDALGetDatasetDriver(dataset_.get())));
    if (bands != 1)
      return Error{Errc::kUnsupported,
                   fmt::format("{} with {} bands; a map of heights has one (gdal_translate -b "
                               "takes one of them)",
                               format, bands)};
    band_ = GDALGetRasterBand(dataset_.get(), 1);
    head_.format = format;
    if (const auto sized = takeSize(); !sized) return sized;
    head_.header.scanner = range::Scanner::kElevation;
    takeCells();
    takeHeights();
    return Ok{};
  }

  void note(std::string text) { head_.notes.push_back(std::move(text)); }

  const range::GridHead& head() const override { return head_; }

  std::string readRow(std::size_t row, std::span<float> values) override {
    row_.resize(values.size());
    const auto width = static_cast<int>(values.size());
    const auto line = static_cast<int>(south_first_ ? head_.height - 1 - row : row);
    if (GDALRasterIO(band_, GF_Read, 0, line, width, 1, row_.data(), width, 1, GDT_Float64, 0, 0) !=
        CE_None)
      return gdalsWords();
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = heightOf(row_[east_first_ ? values.size() - 1 - i : i]);
    return {};
  }

 private:
  Result<Ok> takeSize() {
    const int width = GDALGetRasterXSize(dataset_.get()),
              height = GDALGetRasterYSize(dataset_.get());
    const bool good =
        width > 0 && height > 0 &&
        static_cast<std::size_t>(width) <= range::kMostPixels / static_cast<std::size_t>(height);
    if (!good)
      return Error{Errc::kUnsupported, fmt::format("{} x {} heights; allowed are {}", width, height,
                                                   range::kMostPixels)};
    if (GDALDataTypeIsComplex(GDALGetRasterDataType(band_)) != 0)
      return Error{Errc::kUnsupported, "has complex numbers, which are no heights"};
    head_.width = static_cast<std::size_t>(width);
    head_.height = static_cast<std::size_t>(height);
    return Ok{};
  }

  // Sets the map's cell size, the order of its cells, and its position.
  void takeCells() {
    std::array<double, 6> t{};
    const bool placed = GDALGetGeoTransform(dataset_.get(), t.data()) == CE_None;
    CPLErrorReset();
    const double dx = std::hypot(t[1], t[4]), dy = std::hypot(t[2], t[5]);
    if (!placed || !(dx > 0 && dy > 0 && dx < 1e15 && dy < 1e15)) return;
    if (t[2] != 0 || t[4] != 0)
      head_.notes.emplace_back(
          "the map is rotated against the axes of its projection; the mesh is not");
    south_first_ = t[5] > 0;
    east_first_ = t[1] < 0;
    const auto height = static_cast<double>(head_.height), width = static_cast<double>(head_.width);
    const double column = east_first_ ? width - 0.5 : 0.5, row = south_first_ ? 0.5 : height - 0.5;
    head_.header.origin = {t[0] + column * t[1] + row * t[2], t[3] + column * t[4] + row * t[5]};
    head_.header.cell = {dx, dy};
    takeProjection((*head_.header.origin)[1] + dy * (height - 1) / 2);
  }

  // Guesses whether coordinates are in degrees: small cells at small coordinates are. This is for
  // GTOPO30, for which GDAL provides no projection.
  void guessDegrees(double north) {
    const double east = (*head_.header.origin)[0];
    if ((*head_.header.cell)[0] >= 0.1 || std::abs(east) > 360 || std::abs(north) > 90) return;
    head_.latitude_deg = north;
    head_.notes.emplace_back("the map has no projection; its coordinates are taken as degrees");
  }

  // Sets the projection, and converts the cell size by its unit. `north`: northern coordinate of
  // the map's middle.
  void takeProjection(double north) {
    OGRSpatialReferenceH reference = GDALGetSpatialRef(dataset_.get());
    if (!reference) {
      guessDegrees(north);
      return;
    }
    head_.header.projection = projectionOf(reference);
    auto& cell = *head_.header.cell;
    double unit = 1;
    if (OSRIsGeographic(reference) != 0) {
      unit = OSRGetAngularUnits(reference, nullptr) * 180 / std::numbers::pi;
      if (std::abs(north * unit) <= 90) head_.latitude_deg = north * unit;
    } else {
      unit = OSRGetLinearUnits(reference, nullptr);
    }
    if (unit > 0 && std::isfinite(unit)) cell = {cell[0] * unit, cell[1] * unit};
  }

  void takeHeights() {
    int there = 0;
    const double none = GDALGetRasterNoDataValue(band_, &there);
    if (there != 0) void_ = none;
    single_ = GDALGetRasterDataType(band_) == GDT_Float32;
    factor_ = GDALGetRasterScale(band_, &there);
    if (there == 0 || !std::isfinite(factor_) || factor_ == 0) factor_ = 1;
    offset_ = GDALGetRasterOffset(band_, &there);
    if (there == 0 || !std::isfinite(offset_)) offset_ = 0;
    const std::string unit = GDALGetRasterUnitType(band_);
    const auto metres = metresOf(unit);
    if (metres && *metres != 1) head_.header.scale = *metres;
    if (!metres)
      head_.notes.push_back(
          fmt::format("the unit of height \"{}\" is not known; it is taken as a metre (--scale)",
                      oneLine(excerpt(unit))));
  }

  float heightOf(double stored) const {
    const bool is_void =
        void_ &&
        (stored == *void_ || (single_ && static_cast<float>(stored) == static_cast<float>(*void_)));
    const double height = stored * factor_ + offset_;
    const bool far = !(std::abs(height) <= double{range::kFarthest});  // true for NaN
    return is_void || far ? range::kNoReturn : static_cast<float>(height);
  }

  Dataset dataset_;
  GDALRasterBandH band_ = nullptr;
  range::GridHead head_;
  std::vector<double> row_;
  std::optional<double> void_;
  double factor_ = 1, offset_ = 0;
  bool single_ = false, south_first_ = false, east_first_ = false;
};

Result<Dataset> openDataset(const std::string& address) {
  CPLErrorReset();
  Dataset dataset(GDALOpenEx(address.c_str(),
                             GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                             nullptr, nullptr));
  if (!dataset) return Error{Errc::kMalformed, gdalsWords()};
  return dataset;
}

// A map among several in one file, which GDAL calls a subdataset.
struct Map {
  std::string address;  // address for openDataset()
  std::string name;     // name of its variable; empty: it has none
  std::string about;    // GDAL's description, one line
};

// Returns the name of the variable in an address such as NETCDF:"a.nc":z or HDF5:"a.h5"://maps/z. A
// page of a TIFF file (GTIFF_DIR:1:a.tif) has no name.
std::string variableIn(std::string_view address) {
  if (address.starts_with("GTIFF_DIR")) return {};
  const std::string_view last = address.substr(address.rfind(':') + 1);
  return oneLine(trimmed(last, "/\""));
}

std::vector<Map> mapsOf(GDALDatasetH dataset) {
  constexpr int kMost = 1000;
  // Reads the whole list, since GDALGetMetadataItem() finds no items of netCDF files.
  char** const list = GDALGetMetadata(dataset, "SUBDATASETS");
  const auto item = [&](int number, const char* what) {
    const std::string key = fmt::format("SUBDATASET_{}_{}", number, what);
    const char* text = CSLFetchNameValue(list, key.c_str());
    return std::string(text ? text : "");
  };
  std::vector<Map> maps;
  for (int i = 1; i <= kMost; ++i) {
    const std::string address = item(i, "NAME");
    if (address.empty()) break;
    maps.push_back({address, variableIn(address), oneLine(excerpt(item(i, "DESC")))});
  }
  return maps;
}

std::string listOf(const std::vector<Map>& maps) {
  constexpr std::size_t kNamed = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(maps.size(), kNamed); ++i)
    list += fmt::format("{}{}{} ({})", i == 0 ? "" : ", ", i + 1,
                        maps[i].name.empty() ? "" : fmt::format(" \"{}\"", excerpt(maps[i].name)),
                        maps[i].about);
  return maps.size() > kNamed ? fmt::format("{} and {} more", list, maps.size() - kNamed) : list;
}

// Returns the map with this number, counted from 1, or with this name, ignoring case. If there is
// only one map, `wanted` may be empty. Errors: kInvalidArgument, with the list of maps.
Result<Map> chosenMap(const std::vector<Map>& maps, const std::string& wanted) {
  if (wanted.empty() && maps.size() == 1) return maps.front();
  if (maps.empty())
    return Error{Errc::kInvalidArgument,
                 "--variable is for files with several maps, and this has one; leave it out"};
  for (std::size_t i = 0; i < maps.size() && !wanted.empty(); ++i) {
    const bool named = !maps[i].name.empty() && lowerCase(maps[i].name) == lowerCase(wanted);
    if (named || std::to_string(i + 1) == wanted) return maps[i];
  }
  return Error{Errc::kInvalidArgument,
               wanted.empty()
                   ? fmt::format("has several maps: {}; say which one by --variable NAME, or by "
                                 "its number",
                                 listOf(maps))
                   : fmt::format("has no map {} (--variable); there are {}",
                                 oneLine(excerpt(wanted)), listOf(maps))};
}

}  // namespace

Result<Ok> prepareGdal() {
  constexpr std::pair<const char*, const char*> kSettings[] = {
      {"GDAL_PAM_ENABLED", "NO"},       // no files .aux.xml, read or written
      {"GDAL_DRIVER_PATH", "disable"},  // no readers from elsewhere
      {"GDAL_DISABLE_READDIR_ON_OPEN", "TRUE"},
      {"GDAL_CACHEMAX", "256"},  // [MB]
      {"GDAL_NUM_THREADS", "1"},
      {"PROJ_NETWORK", "OFF"}};
  for (const auto& [name, value] : kSettings) CPLSetConfigOption(name, value);
  CPLSetErrorHandler(CPLQuietErrorHandler);
  GDALAllRegister();
  for (int i = GDALGetDriverCount() - 1; i >= 0; --i) {
    GDALDriverH driver = GDALGetDriver(i);
    if (!isAllowed(driver)) GDALDeregisterDriver(driver);
  }
  if (GDALGetDriverCount() > 0) return Ok{};
  return Error{Errc::kUnsupported, "GDAL has no readers"};
}

Result<std::unique_ptr<GridSource>> openGdal(const std::string& path, const std::string& wanted) {
  auto dataset = openDataset(path);
  if (!dataset) return dataset.error();
  const std::vector<Map> maps = mapsOf(dataset->get());
  const bool has_bands = GDALGetRasterCount(dataset->get()) > 0;
  if (!wanted.empty() || (!has_bands && !maps.empty())) {
    const auto map = chosenMap(maps, wanted);
    if (!map) return map.error();
    dataset = openDataset(map->address);
    if (!dataset) return dataset.error();
  }
  auto grid = std::make_unique<GdalGrid>(*std::move(dataset));
  if (wanted.empty() && has_bands && maps.size() > 1)
    grid->note(
        fmt::format("there are several maps: {}; the first is read (--variable reads "
                    "another one)",
                    listOf(maps)));
  if (const auto prepared = grid->prepare(); !prepared) return prepared.error();
  return std::unique_ptr<GridSource>(std::move(grid));
}

}  // namespace merlin::render::import
