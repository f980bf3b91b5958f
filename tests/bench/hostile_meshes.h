// Small meshes as nobody wants them, made of a seed: what the fuzz of the mesh part feeds.
#pragma once

#include <cstdint>

#include "render/mesh/mesh.h"

namespace merlin::bench {

// The mesh of this seed; the same on every machine. Some are refused by validate(), by intent.
render::Mesh hostileMesh(std::uint64_t seed);

}  // namespace merlin::bench
