// PatternReducer: the algorithm POLYMUR, one collapse at a time. Private to render/reduce.
//
// [GOURLEY98] 4.3, figure 4.6. Thread-bound.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "render/mesh/mesh.h"
#include "render/reduce/pattern/edge_heap.h"
#include "render/reduce/pattern/working_mesh.h"
#include "render/reduce/pattern_space.h"
#include "render/reduce/reduce.h"

namespace merlin::render::reduce {

class PatternReducer {
 public:
  PatternReducer(const mesh::Mesh& mesh, const PatternSpace& space, bool preserve_topology,
                 bool preserve_components = false);

  enum class Step { kDone, kNothingLeft, kTooCoarse };

  // Collapses the shortest edge that the rules allow, unless its error would be more than
  // `max_error` (model units).
  Step collapseShortest(double max_error = std::numeric_limits<double>::infinity());

  // Raises the limit of triangles per vertex and recomputes the lengths of all edges. Returns
  // false, and does nothing, if that limit has refused no edge.
  bool allowLargerStars();

  // Lets components vanish from now on; recomputes the lengths of all edges.
  void releaseComponents();

  std::size_t collapses() const noexcept { return result_.log.children.size(); }
  std::size_t triangles() const noexcept { return surface_.liveTriangles(); }

  // Distance of the present weighted pattern vectors of two vertices: the length of an edge between
  // them, equation 4.3.
  float patternDistance(std::uint32_t a, std::uint32_t b) const noexcept;

  // Returns the result and leaves the reducer empty. The caller must fill `stopped` and `about`.
  Reduction finish() &&;

 private:
  using Vec3 = std::array<float, 3>;

  // A candidate collapse: vertex b is removed, vertex a moves to `position`.
  struct Plan {
    std::uint32_t a = 0, b = 0;
    float towards_b = 0;  // 0: at a, 1: at b, 0.5: midpoint
    Vec3 position{};
  };

  const float* position(std::uint32_t v) const noexcept { return &positions_[3 * std::size_t{v}]; }
  Plan plan(std::uint32_t edge) const;
  bool isSmallEnough(std::uint32_t edge);
  bool mayGo(const Plan& plan, std::uint32_t edge);
  void measureAll();
  float sharpness(std::uint32_t v) const;
  bool flips(const Plan& plan);
  std::array<float, 2> planeDistances(const Plan& plan) const;
  float errorAfter(const Plan& plan) const;
  void apply(const Plan& plan, std::uint32_t edge, float error);
  void mixFeatures(const Plan& plan);
  void recordNode(const Plan& plan, float error);
  void makePattern(std::uint32_t v);
  float lengthOf(std::uint32_t edge) const noexcept {
    const auto [a, b] = surface_.ends(edge);
    return patternDistance(a, b);
  }
  void lengthen(std::uint32_t edge);

  WorkingMesh surface_;
  const PatternSpace& space_;
  bool preserve_topology_, preserve_components_;
  // Limit of triangles per vertex, higher than useful surfaces need, and the smallest number above
  // the limit that was refused.
  static constexpr std::size_t kNoneLeftOut = std::numeric_limits<std::size_t>::max();
  std::size_t most_triangles_ = 128, smallest_left_out_ = kNoneLeftOut;
  std::vector<float> positions_;         // by vertex, present values
  std::vector<mesh::Feature> features_;  // by vertex, present values
  std::size_t normal_ = 0;               // index of "normal" in features_
  std::vector<float> patterns_;          // by vertex: weighted pattern vectors
  std::vector<std::uint8_t> boundary_;   // by vertex
  std::vector<float> error_;             // by vertex: accumulated, equation 4.10
  std::vector<std::uint32_t> node_;      // by vertex: its node in the log
  EdgeHeap heap_;
  std::vector<float> new_normals_;  // scratch: normals of the plan's new faces, 3 floats each
  Reduction result_;
};

}  // namespace merlin::render::reduce
