// What the tests of the reducer share: collapses in an order that the test says.
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
using render::Reduction;

// Adds a scalar feature, and normals before it.
inline void addFeature(Mesh& mesh, const char* name, Floats values) {
  ensureNormals(mesh);
  mesh.features.push_back({name, 1, std::move(values)});
}

// The weight that makes a difference of 1 in the feature a length of `unit`, whatever its extent.
inline std::pair<std::string, float> weightOf(const Mesh& mesh, const char* name, float unit = 1) {
  const Floats& v = mesh.find(name)->values;
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  return {name, unit * (*high - *low)};
}

// The first `collapses` collapses in the order of `weights`.
inline Reduction collapse(const Mesh& mesh, const render::Weights& weights, int collapses) {
  const auto space = render::PatternSpace::make(mesh, weights);
  EXPECT_TRUE(space);
  render::PatternReducer reducer(mesh, *space, false);
  for (int i = 0; i < collapses; ++i) {
    EXPECT_EQ(reducer.collapseShortest(), render::PatternReducer::Step::kDone);
  }
  return std::move(reducer).finish();
}

// By the feature "order" alone.
inline Reduction collapseInOrder(const Mesh& mesh, int collapses) {
  return collapse(mesh, {weightOf(mesh, "order")}, collapses);
}

// Of the new vertex of a collapse.
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
