#include "render/governor/settings.h"

#include <fmt/format.h>

namespace merlin::render::governor {

SettingFaults validate(const GovernorSettings& g) {
  if (g.min_triangles <= g.first_triangles && g.first_triangles <= g.max_triangles) return {};
  return {
      {"", fmt::format("has min_triangles {}, first_triangles {}, max_triangles {}; they must be "
                       "in ascending order",
                       g.min_triangles, g.first_triangles, g.max_triangles)}};
}

}  // namespace merlin::render::governor
