// A mesh as Open Inventor text, for a file of its own or a part of another.
#pragma once

#include "render/mesh/io/text_sink.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

// The file's first line.
inline constexpr std::string_view kInventorHeader = "#Inventor V2.1 ascii\n\n# written by MERLIN\n";

// Lit from both sides, since scans have borders.
inline constexpr std::string_view kInventorHints =
    "  ShapeHints {\n    vertexOrdering COUNTERCLOCKWISE\n"
    "    shapeType UNKNOWN_SHAPE_TYPE\n    faceType CONVEX\n  }\n";

// "Separator { ... }" with an IndexedFaceSet: "normal", "colour" and "texcoord" where they are
// there in their usual dimensions; of a picture in a file beside it its name, instead of colours,
// which it would be multiplied with.
void printSeparator(TextSink& out, const Mesh& mesh, const std::string& picture = "");

}  // namespace merlin::render
