// Lists the names of the PLY vertex properties that form the features "normal", "colour" and
// "texcoord". Private to render/mesh/io and render/range/io.
#pragma once

#include <cstddef>

namespace merlin::render::mesh::ply {

// Maps a property to component `offset` of a feature. Several properties may map to the same
// component; the writer uses the first property of a component.
struct PropertyMapping {
  const char* property;
  const char* feature;
  std::size_t dimension, offset;
};
inline constexpr PropertyMapping kPropertyMappings[] = {
    {"nx", "normal", 3, 0},
    {"ny", "normal", 3, 1},
    {"nz", "normal", 3, 2},
    {"red", "colour", 3, 0},
    {"green", "colour", 3, 1},
    {"blue", "colour", 3, 2},
    {"r", "colour", 3, 0},
    {"g", "colour", 3, 1},
    {"b", "colour", 3, 2},
    {"s", "texcoord", 2, 0},
    {"t", "texcoord", 2, 1},
    {"u", "texcoord", 2, 0},
    {"v", "texcoord", 2, 1},
    {"texture_u", "texcoord", 2, 0},
    {"texture_v", "texcoord", 2, 1},
    {"tx", "texcoord", 2, 0},
    {"ty", "texcoord", 2, 1},
    {"diffuse_red", "colour", 3, 0},
    {"diffuse_green", "colour", 3, 1},
    {"diffuse_blue", "colour", 3, 2},
};

}  // namespace merlin::render::mesh::ply
