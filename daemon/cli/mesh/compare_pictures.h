// Draws the images of `merlin mesh compare`: two surfaces from the same viewpoint, and their
// difference.
#pragma once

#include <string>

#include "daemon/cli/mesh/view_options.h"
#include "render/mesh/mesh.h"

namespace merlin::cli {

// Writes a.png, b.png, a_wire.png, b_wire.png (wireframes), beside.png (a and b side by side),
// difference.png and edges.png (edgeBands() of b, by the rank of lengths in space) into `folder`,
// which is created if necessary; all from the same viewpoint and at the same scale. Returns
// PictureDifference::changed_percent: the share of the pixels on the model that differ visibly
// [percent]. Memory: about 0.6 kB per triangle of b. Errors: kIo, kNotFound (the folder),
// kUnsupported (OpenGL is not available).
Result<double> writePictures(const std::string& folder, const render::mesh::Mesh& a,
                             const render::mesh::Mesh& b, const View& view);

}  // namespace merlin::cli
