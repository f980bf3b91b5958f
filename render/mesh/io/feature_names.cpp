#include "render/mesh/io/feature_names.h"

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "render/mesh/io/ply_features.h"

namespace merlin::render::mesh {

std::string featureNameFault(const std::string& name) {
  if (name.empty() || !isText(name) || name.find(' ') != std::string::npos)
    return "the name of a feature is one word";
  if (name == "x" || name == "y" || name == "z")
    return fmt::format("the name {} is a coordinate's", name);
  for (const ply::PropertyMapping& k : ply::kPropertyMappings) {
    if (name == k.property)
      return fmt::format("the name {} means a part of the {} in PLY files", name, k.feature);
  }
  return {};
}

}  // namespace merlin::render::mesh
