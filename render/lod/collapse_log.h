// CollapseLog: what a reduction did, in order. The reducer writes it, buildDendrogram() reads it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace merlin::render {

// Nodes 0..vertices-1 are the mesh's vertices; collapse k makes node vertices + k.
struct CollapseLog {
  std::vector<std::array<std::uint32_t, 2>> children;  // the two nodes that collapse k merges
  std::vector<float> positions;                        // of the new nodes, collapses x 3
  std::vector<std::vector<float>> features;  // per feature of the mesh: collapses x dimension
  std::vector<float> error;                  // of the new node's surface, model units, estimate
  std::string about;  // "key=value" lines: cost, weights, why it stopped; goes into the file
};

}  // namespace merlin::render
