// A surface as `quadric` holds it, with what measures one vertex.
#pragma once

#include "render/reduce/quadric/quadric_evaluate.h"

namespace merlin::test {

struct QuadricBench {
  explicit QuadricBench(const render::Mesh& mesh, std::size_t channels = 0)
      : surface(mesh), values(mesh.vertexCount(), channels) {}

  render::QuadricView view() const { return {&surface[0], surface.corners(0), &values}; }
  void evaluateAll(render::EvaluateEdges evaluate = render::edgeEvaluator()) {
    for (std::uint32_t v = 0; v < surface.vertexCount(); ++v) evaluate(view(), v, costs);
  }

  render::QuadricMesh surface;
  render::QuadricChannels values;
  render::EdgeCosts costs;
};

}  // namespace merlin::test
