// A sample reader: text files in which each line holds the nine coordinates of a triangle ("RAW
// triangles"). It shows what a format takes; the product's table does not have it.
#pragma once

#include "render/mesh/io/reader.h"

namespace merlin::render {

extern const MeshReader kRawTrianglesReader;

}  // namespace merlin::render
