// PatternReducer: carries out the algorithm POLYMUR, one collapse per call. Private to
// render/reduce.
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

  // Collapses the shortest edge that the rules allow and returns kDone. Returns kTooCoarse, without
  // a collapse, if the error would exceed `max_error` (model units); returns kNothingLeft if the
  // rules allow no edge.
  Step collapseShortest(double max_error = std::numeric_limits<double>::infinity());

  // Raises the limit of triangles per vertex and recomputes the lengths of all edges. If the
  // present limit has not refused any edge, returns false and changes nothing.
  bool allowLargerStars();

  // From now on lets collapses remove whole components; recomputes the lengths of all edges.
  void releaseComponents();

  std::size_t collapses() const noexcept { return result_.log.children.size(); }
  std::size_t triangles() const noexcept { return surface_.liveTriangles(); }

  // Returns the distance between the current weighted pattern vectors of two vertices, which is the
  // length of an edge between them (equation 4.3).
  float patternDistance(std::uint32_t a, std::uint32_t b) const noexcept;

  // Returns the result and leaves the reducer empty. The caller must fill `stopped` and `about`.
  Reduction finish() &&;

 private:
  using Vec3 = std::array<float, 3>;

  // A candidate collapse: vertex b is removed, vertex a moves to `position`.
  struct Plan {
    std::uint32_t a = 0, b = 0;
    float towards_b = 0;  // where `position` is on the edge: 0 at a, 1 at b, 0.5 midpoint
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
  // most_triangles_: limit of triangles per vertex, above what useful surfaces need.
  // smallest_left_out_: the smallest number of triangles that this limit has refused.
  static constexpr std::size_t kNoneLeftOut = std::numeric_limits<std::size_t>::max();
  std::size_t most_triangles_ = 128, smallest_left_out_ = kNoneLeftOut;
  std::vector<float> positions_;         // by vertex: current coordinates [model units]
  std::vector<mesh::Feature> features_;  // current values, by vertex
  std::size_t normal_ = 0;               // index of "normal" in features_
  std::vector<float> patterns_;          // by vertex: weighted pattern vectors
  std::vector<std::uint8_t> boundary_;   // by vertex
  // by vertex: accumulated error, equation 4.10 [model units]
  std::vector<float> error_;
  std::vector<std::uint32_t> node_;  // by vertex: index of its node in the log
  EdgeHeap heap_;
  std::vector<float> new_normals_;  // scratch: normals of the plan's new faces, 3 floats each
  Reduction result_;
};

}  // namespace merlin::render::reduce
