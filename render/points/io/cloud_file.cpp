#include "render/points/io/cloud_file.h"

#include <algorithm>
#include <iterator>

#include "daemon/base/files.h"
#include "render/points/io/las.h"
#include "render/points/io/pcd_cloud.h"
#include "render/points/io/ply_cloud.h"
#include "render/points/io/xyz.h"

namespace merlin::render::points {
namespace {

bool isE57(std::string_view bytes) { return bytes.starts_with("ASTM-E57"); }

Result<PointCloud> refuseE57(std::string_view) {
  return Error{Errc::kUnsupported,
               "is E57, which is not read; convert it with: pdal translate IN.e57 OUT.las"};
}

struct CloudReader {
  const char* format;
  bool (*is)(std::string_view bytes);
  Result<PointCloud> (*parse)(std::string_view bytes);
};
constexpr CloudReader kReaders[] = {{"LAS", isLas, parseLas},
                                    {"E57", isE57, refuseE57},
                                    {"PCD", isPcdCloud, parsePcdCloud},
                                    {"PLY without faces", isPlyCloud, parsePlyCloud},
                                    {"XYZ", isXyz, parseXyz}};
constexpr const CloudReader& kTextReader = kReaders[std::size(kReaders) - 1];

}  // namespace

std::optional<std::string> cloudFormatOf(std::string_view bytes) {
  for (const CloudReader& reader : kReaders)
    if (&reader != &kTextReader && reader.is(bytes)) return reader.format;
  return std::nullopt;
}

std::optional<std::string> textCloudFormatOf(std::string_view bytes) {
  return kTextReader.is(bytes) ? std::optional<std::string>(kTextReader.format) : std::nullopt;
}

std::string readableClouds() {
  return "LAS 1.2 to 1.4, PCD without rows, PLY without faces and XYZ text";
}

Result<PointCloud> parseCloud(std::string_view bytes) {
  for (const CloudReader& reader : kReaders) {
    if (!reader.is(bytes)) continue;
    auto cloud = reader.parse(bytes);
    if (!cloud) return cloud;
    if (const auto good = keepFinite(*cloud); !good) return good.error();
    return cloud;
  }
  return Error{Errc::kUnsupported, "is not a point cloud; supported are " + readableClouds()};
}

Result<PointCloud> readCloud(const std::string& path) {
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  auto cloud = parseCloud(file->text());
  if (!cloud) return Error{cloud.error().code, path + ": " + cloud.error().what};
  return cloud;
}

}  // namespace merlin::render::points
