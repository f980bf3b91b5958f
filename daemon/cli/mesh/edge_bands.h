// Converts the edges of a mesh to coloured bands, so that a picture shows their lengths.
#pragma once

#include <span>
#include <vector>

#include "daemon/cli/mesh/view_options.h"
#include "render/mesh/mesh.h"

namespace merlin::cli {

// Returns the length in space of each edge of each triangle, 3 per triangle, in the order of
// render/reduce/edge_lengths.h.
std::vector<float> lengthsInSpace(const render::mesh::Mesh& mesh);

// Return the position of each length on the colour scale, from 0 for the shortest to 1 for the
// longest. ranksOf() uses the rank among all lengths, so that all colours are used equally often;
// equal lengths have the same rank, the mean of their ranks. sizesOf() is linear in the length, as
// in [GOURLEY98] figure 5.1, from the 1st to the 99th percentile (or from the shortest to the
// longest if these percentiles are equal), so that edges of equal cost, such as those of flat parts
// weighted by curvature, have the same colour.
std::vector<float> ranksOf(std::span<const float> lengths);
std::vector<float> sizesOf(std::span<const float> lengths);

// Returns a mesh that shows the edges of `mesh`: in each triangle a coloured band along each edge,
// from red (shortest) to blue (longest). `places`: position on the colour scale (0 to 1) of each
// edge, 3 per triangle: from corner 0 to 1, 1 to 2 and 2 to 0. The normals point to the light of
// `view`, so that bandView() shows the colours without shading. Memory: about 0.6 kB per triangle.
render::mesh::Mesh edgeBands(const render::mesh::Mesh& mesh, std::span<const float> places,
                             const View& view);

// Adds two opposite corners of the other mesh's bounding box as vertices without a triangle, and
// normals if it has none. The renderer scales a model by the bounding box of its vertices, so both
// meshes are then drawn at the same scale.
render::mesh::Mesh framed(render::mesh::Mesh mesh, const render::mesh::Mesh& other);

// Returns the view from the same viewpoint, with a style that suits a mesh of edgeBands(): no
// wireframe, brightness 1 and its own colours.
View bandView(View view);

}  // namespace merlin::cli
