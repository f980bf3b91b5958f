// CollapseLog: the collapses of a reduction, in order. The reducer writes it, buildDendrogram()
// reads it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace merlin::render::lod {

// Nodes 0..vertices-1 are the mesh's vertices; collapse k makes node vertices + k.
struct CollapseLog {
  std::vector<std::array<std::uint32_t, 2>> children;  // the two nodes that collapse k merges
  std::vector<float> positions;                        // positions of the new nodes: collapses x 3
  // Values per feature of the mesh: collapses x dimension.
  std::vector<std::vector<float>> features;
  std::vector<float> error;  // estimated error of the surface at the new node [model units]
  std::string about;         // "key=value" lines: cost, weights, why it stopped; stored in .mrm
};

}  // namespace merlin::render::lod
