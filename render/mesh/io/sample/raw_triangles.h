// An example of a reader: reads text files in which each line holds the nine coordinates of a
// triangle ("RAW triangles"). It shows what a new format needs; it is not in the table of readers.
#pragma once

#include "render/mesh/io/reader.h"

namespace merlin::render::mesh {

extern const MeshReader kRawTrianglesReader;

}  // namespace merlin::render::mesh
