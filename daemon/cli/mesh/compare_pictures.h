// The pictures of `merlin mesh compare`: two surfaces from the same view, and how they differ.
#pragma once

#include <string>

#include "daemon/cli/mesh/view_options.h"
#include "render/mesh/mesh.h"

namespace merlin::cli {

// `mesh` with a coloured band along each edge, from red (shortest) to blue (longest) by rank
// ([GOURLEY98] figure 5.1). The normals are such that drawing it from `view` shows no shading.
render::Mesh edgeBands(const render::Mesh& mesh, const View& view);

// Writes a.png, b.png, a_wire.png, b_wire.png, beside.png (a and b side by side), difference.png
// and edges.png (edgeBands() of b) into `folder`, which is created if necessary; all from the same
// eye and at the same scale. Returns changed_percent. Memory: about 0.6 kB per triangle of b.
// Errors: kIo, kNotFound (the folder), kUnsupported (no GL).
Result<double> writePictures(const std::string& folder, const render::Mesh& a,
                             const render::Mesh& b, const View& view);

}  // namespace merlin::cli
