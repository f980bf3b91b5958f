// Small degenerate or invalid meshes, generated from a seed; the input of the mesh fuzzer.
#pragma once

#include <cstdint>

#include "render/mesh/mesh.h"

namespace merlin::bench {

// Returns the mesh for this seed, the same on every machine. Some meshes are invalid on purpose.
render::mesh::Mesh hostileMesh(std::uint64_t seed);

}  // namespace merlin::bench
