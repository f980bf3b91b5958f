// Shared by the tests of the reducer: edge collapses in an order that the test chooses.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "render/reduce/pattern/pattern_reducer.h"
#include "tests/support/meshes.h"

namespace merlin::test {

using Floats = std::vector<float>;
using Children = std::array<std::uint32_t, 2>;
using render::reduce::Reduction;

// Adds a scalar feature, after normals if the mesh has none.
inline void addFeature(Mesh& mesh, const char* name, Floats values) {
  ensureNormals(mesh);
  mesh.features.push_back({name, 1, std::move(values)});
}

// Returns a weight with which a difference of 1 in the feature counts as a length of `unit`,
// whatever the feature's range.
inline std::pair<std::string, float> weightOf(const Mesh& mesh, const char* name, float unit = 1) {
  const Floats& v = mesh.find(name)->values;
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  return {name, unit * (*high - *low)};
}

// Performs the first `collapses` collapses in the order that follows from `weights`.
inline Reduction collapse(const Mesh& mesh, const render::reduce::Weights& weights, int collapses) {
  const auto space = render::reduce::PatternSpace::make(mesh, weights);
  EXPECT_TRUE(space);
  render::reduce::PatternReducer reducer(mesh, *space, false);
  for (int i = 0; i < collapses; ++i) {
    EXPECT_EQ(reducer.collapseShortest(), render::reduce::PatternReducer::Step::kDone);
  }
  return std::move(reducer).finish();
}

// Orders the collapses by the feature "order" alone.
inline Reduction collapseInOrder(const Mesh& mesh, int collapses) {
  return collapse(mesh, {weightOf(mesh, "order")}, collapses);
}

// Returns the position of the vertex that a collapse created.
inline Floats position(const Reduction& r, std::size_t collapse) {
  const auto at = r.log.positions.begin() + 3 * static_cast<std::ptrdiff_t>(collapse);
  return {at, at + 3};
}

inline void moveTo(Mesh& mesh, std::size_t v, float x, float y, float z) {
  mesh.positions[3 * v] = x;
  mesh.positions[3 * v + 1] = y;
  mesh.positions[3 * v + 2] = z;
}

}  // namespace merlin::test
