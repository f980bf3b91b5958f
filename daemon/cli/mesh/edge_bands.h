// The edges of a mesh as a mesh of coloured bands, by which a picture shows their lengths.
#pragma once

#include <span>
#include <vector>

#include "daemon/cli/mesh/view_options.h"
#include "render/mesh/mesh.h"

namespace merlin::cli {

// The length in space of each triangle's edges, in the order of render/reduce/edge_lengths.h.
std::vector<float> lengthsInSpace(const render::mesh::Mesh& mesh);

// The place of each length on the colour scale, from 0 for the shortest to 1 for the longest.
// ranksOf(): its rank among all lengths, so that all colours are used equally, however different
// the lengths are; equal lengths have one rank, that of their middle. sizesOf(): by its size, as in
// [GOURLEY98] figure 5.1, from the 1st to the 99th percentile of all (from the shortest to the
// longest if these percentiles are equal), so that edges of equal cost, such as those of flat parts
// that are weighted by curvature, have one colour.
std::vector<float> ranksOf(std::span<const float> lengths);
std::vector<float> sizesOf(std::span<const float> lengths);

// Returns a mesh that shows the edges of `mesh`: in each triangle a coloured band along each edge,
// from red (shortest) to blue (longest). `places`: the place on this scale, 0..1, of the edge from
// each corner of each triangle to the next one. The normals point at the light of `view`, so that
// bandView() shows the colours without shading. Memory: about 0.6 kB per triangle.
render::mesh::Mesh edgeBands(const render::mesh::Mesh& mesh, std::span<const float> places,
                             const View& view);

// Adds two opposite corners of the other mesh's bounding box as vertices without a triangle, and
// normals if it has none. A model is scaled by the bounding box of its vertices, so both meshes are
// then drawn at the same scale.
render::mesh::Mesh framed(render::mesh::Mesh mesh, const render::mesh::Mesh& other);

// The same viewpoint, for a mesh of edgeBands().
View bandView(View view);

}  // namespace merlin::cli
