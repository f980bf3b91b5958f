// Writes a mesh as Open Inventor text, as a separate file or as a part of a larger one.
#pragma once

#include <string>

#include "render/mesh/io/text_sink.h"
#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// The first lines of an Open Inventor file.
inline constexpr std::string_view kInventorHeader = "#Inventor V2.1 ascii\n\n# written by MERLIN\n";

// ShapeHints node that makes viewers light both sides of each face: scans have borders, so back
// faces can be seen.
inline constexpr std::string_view kInventorHints =
    "  ShapeHints {\n    vertexOrdering COUNTERCLOCKWISE\n"
    "    shapeType UNKNOWN_SHAPE_TYPE\n    faceType CONVEX\n  }\n";

// Returns the node that applies the texture image with the file name `picture` to the shapes after
// it.
std::string textureNode(const std::string& picture);

// Writes "Separator { ... }" with an IndexedFaceSet and the features "normal", "colour" and
// "texcoord" that the mesh has in their usual dimensions. `texture`: the text of a textureNode(),
// or a reference to a node that was written before; empty: no texture. A textured mesh is written
// without colours, since viewers multiply the texture by them.
void printSeparator(TextSink& out, const Mesh& mesh, const std::string& texture = "");

}  // namespace merlin::render::mesh
