#include "render/reduce/edge_lengths.h"

#include "render/reduce/pattern/pattern_reducer.h"

namespace merlin::render::reduce {

// Calls the reducer itself, so that the lengths shown to the user are those that the reduction
// uses.
Result<std::vector<float>> edgeLengths(const mesh::Mesh& mesh, const Weights& weights) {
  const auto space = PatternSpace::make(mesh, weights);
  if (!space) return space.error();
  const PatternReducer reducer(mesh, *space, false);
  std::vector<float> lengths;
  lengths.reserve(mesh.triangles.size());
  for (std::size_t first = 0; first < mesh.triangles.size(); first += 3) {
    for (std::size_t k = 0; k < 3; ++k)
      lengths.push_back(
          reducer.patternDistance(mesh.triangles[first + k], mesh.triangles[first + (k + 1) % 3]));
  }
  return lengths;
}

}  // namespace merlin::render::reduce
