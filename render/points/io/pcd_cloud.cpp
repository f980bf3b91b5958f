#include "render/points/io/pcd_cloud.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "render/range/io/pcd.h"
#include "render/range/io/pcd_body.h"

namespace merlin::render::points {
namespace {

using range::PcdField;
using range::PcdHeader;
using range::PcdValues;

constexpr std::string_view kAxisFields[] = {"x", "y", "z"};
constexpr std::string_view kNormalFields[] = {"normal_x", "normal_y", "normal_z"};

// Returns the values of the three named fields; fewer entries if a field is missing.
std::vector<const PcdValues*> three(const PcdHeader& header, const std::vector<PcdValues>& values,
                                    const std::string_view (&names)[3]) {
  std::vector<const PcdValues*> found;
  for (const std::string_view name : names) {
    if (const PcdValues* field = range::findField(header, values, name)) found.push_back(field);
  }
  return found;
}

bool isAmong(const std::string_view (&names)[3], const std::string& name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

mesh::Feature normalOf(const std::vector<const PcdValues*>& axes) {
  mesh::Feature normal{"normal", 3, {}};
  normal.values.reserve(3 * axes[0]->size());
  for (std::size_t p = 0; p < axes[0]->size(); ++p) {
    for (const PcdValues* axis : axes) normal.values.push_back(static_cast<float>((*axis)[p]));
  }
  return normal;
}

void addFeatures(const PcdHeader& header, const std::vector<PcdValues>& values, PointCloud& cloud) {
  const auto normal = three(header, values, kNormalFields);
  if (normal.size() == 3) cloud.features.push_back(normalOf(normal));
  for (std::size_t f = 0; f < values.size(); ++f) {
    const PcdField& field = header.fields[f];
    if (field.name == "_" || isAmong(kAxisFields, field.name) || isAmong(kNormalFields, field.name))
      continue;
    const bool packed = isPackedColour(field);
    const std::string name = packed ? "colour" : field.name;
    if (cloud.find(name) || (!packed && (name == "colour" || name == "normal"))) {
      cloud.notes.push_back(fmt::format("the field {} is left out", oneLine(field.name)));
    } else if (packed) {
      cloud.features.push_back({"colour", 3, range::unpackedColour(values[f])});
    } else {
      cloud.features.push_back({name, field.count, {values[f].begin(), values[f].end()}});
    }
  }
}

// Sets the viewpoint of the cloud, unless it is 0 0 0, which PCL writes if it knows no viewpoint.
void addViewpoint(const PcdHeader& header, PointCloud& cloud) {
  const auto& v = header.viewpoint;
  if (v[0] == 0 && v[1] == 0 && v[2] == 0) return;
  for (std::size_t k = 0; k < 3; ++k)
    cloud.viewpoint[k] = static_cast<float>(v[k] - cloud.origin[k]);
  cloud.side = Side::kViewpoint;
}

}  // namespace

bool isPcdCloud(std::string_view bytes) {
  if (!range::isPcd(bytes)) return false;
  const auto header = range::parsePcdHeader(bytes);
  return header && header->height == 1;
}

Result<PointCloud> parsePcdCloud(std::string_view bytes) {
  const auto header = range::parsePcdHeader(bytes);
  if (!header) return header.error();
  const auto values = range::readPcdBody(bytes, *header);
  if (!values) return values.error();
  const auto axes = three(*header, *values, kAxisFields);
  if (axes.size() != 3) return Error{Errc::kMalformed, "has no fields x, y and z"};
  PointCloud cloud;
  cloud.format = "PCD";
  cloud.origin = mesh::originNear({(*axes[0])[0], (*axes[1])[0], (*axes[2])[0]});
  cloud.positions.reserve(3 * header->points);
  for (std::size_t p = 0; p < header->points; ++p) {
    for (std::size_t k = 0; k < 3; ++k)
      cloud.positions.push_back(static_cast<float>((*axes[k])[p] - cloud.origin[k]));
  }
  addFeatures(*header, *values, cloud);
  addViewpoint(*header, cloud);
  return cloud;
}

}  // namespace merlin::render::points
