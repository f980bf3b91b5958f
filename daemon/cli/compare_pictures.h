// What two surfaces look like beside one another: the pictures of `merlin mesh compare`.
#pragma once

#include <string>

#include "daemon/cli/view_options.h"
#include "render/mesh/mesh.h"

namespace merlin::cli {

// How much of two pictures of one size differs: a pixel has changed where a channel has by more
// than 15 % of its range (P14).
struct PictureDifference {
  render::Image image;  // changed pixels white, the others black
  // Of the pixels that are not `background` in both pictures.
  double changed_percent = 0;
};
PictureDifference differenceOf(const render::Image& a, const render::Image& b,
                               const std::array<float, 3>& background);

// `mesh` as bands of colour along its edges, the shortest red, the longest blue, by rank (P13); to
// be drawn from `view`, in which it has no shading.
render::Mesh edgeBands(const render::Mesh& mesh, const View& view);

// Writes a.png, b.png, a_wire.png, b_wire.png, beside.png (a and b), difference.png and edges.png
// (of b) into `folder`, made where it is not there: all from one eye and at one scale. Returns
// changed_percent. Takes about 0.6 kB a triangle of b. Errors: kIo, kNotFound (the folder),
// kUnsupported (no GL).
Result<double> writePictures(const std::string& folder, const render::Mesh& a,
                             const render::Mesh& b, const View& view);

}  // namespace merlin::cli
