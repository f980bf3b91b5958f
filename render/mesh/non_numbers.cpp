#include "render/mesh/non_numbers.h"

#include <cmath>

#include <fmt/format.h>

namespace merlin::render::mesh {

std::string replaceNonNumbers(std::vector<Feature>& features) {
  std::size_t replaced = 0;
  for (Feature& f : features) {
    for (float& value : f.values) {
      if (std::isfinite(value)) continue;
      value = 0;
      ++replaced;
    }
  }
  if (replaced == 0) return {};
  return fmt::format("{} values of features were not numbers; 0 stands there", replaced);
}

}  // namespace merlin::render::mesh
