// QuadricBench: a mesh in the representation of render/reduce/quadric, with channel values and edge
// costs.
#pragma once

#include "render/reduce/quadric/quadric_evaluate.h"

namespace merlin::test {

struct QuadricBench {
  explicit QuadricBench(const render::mesh::Mesh& mesh, std::size_t channels = 0)
      : surface(mesh), values(mesh.vertexCount(), channels) {}

  render::reduce::QuadricView view() const { return {&surface[0], surface.corners(0), &values}; }
  void evaluateAll(render::reduce::EvaluateEdges evaluate = render::reduce::edgeEvaluator()) {
    for (std::uint32_t v = 0; v < surface.vertexCount(); ++v) evaluate(view(), v, costs);
  }

  render::reduce::QuadricMesh surface;
  render::reduce::QuadricChannels values;
  render::reduce::EdgeCosts costs;
};

}  // namespace merlin::test
