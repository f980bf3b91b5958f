// PatternReducer: the loop of POLYMUR, one collapse at a time. Private to render/reduce.
//
// [GOURLEY98] 4.3, figure 4.6. Row numbers are those of the project's specification of 1998's
// system (README.md). Thread-bound.
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

namespace merlin::render {

class PatternReducer {
 public:
  PatternReducer(const Mesh& mesh, const PatternSpace& space, bool preserve_topology,
                 bool preserve_components = false);

  enum class Step { kDone, kNothingLeft, kTooCoarse };

  // Collapses the shortest edge that may be, unless its error is more than `max_error`.
  Step collapseShortest(double max_error = std::numeric_limits<double>::infinity());

  // From here on vertices may have more triangles than before. Measures all edges again. False, and
  // nothing done, where no edge had to wait for that.
  bool allowLargerStars();

  // From here on components may vanish. Measures all edges again.
  void releaseComponents();

  std::size_t collapses() const noexcept { return result_.log.children.size(); }
  std::size_t triangles() const noexcept { return surface_.liveTriangles(); }

  // Leaves the reducer empty. `stopped` and `about` are the caller's to fill.
  Reduction finish() &&;

 private:
  using Vec3 = std::array<float, 3>;

  // A collapse that is being considered: b goes, a stays and moves.
  struct Plan {
    std::uint32_t a = 0, b = 0;
    float towards_b = 0;  // 0: a's place, 1: b's, 0.5: the middle
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
  float lengthOf(std::uint32_t edge) const noexcept;
  void lengthen(std::uint32_t edge);

  WorkingMesh surface_;
  const PatternSpace& space_;
  bool preserve_topology_, preserve_components_;
  // That a vertex may have: more than on a surface of any use. The least that waits for more.
  static constexpr std::size_t kNoneLeftOut = std::numeric_limits<std::size_t>::max();
  std::size_t most_triangles_ = 128, smallest_left_out_ = kNoneLeftOut;
  std::vector<float> positions_;        // by vertex, as they move
  std::vector<Feature> features_;       // by vertex, as they change
  std::size_t normal_ = 0;              // index of "normal" in features_
  std::vector<float> patterns_;         // by vertex: weighted pattern vectors
  std::vector<std::uint8_t> boundary_;  // by vertex
  std::vector<float> error_;            // by vertex: accumulated, equation 4.10
  std::vector<std::uint32_t> node_;     // by vertex: its node in the log
  EdgeHeap heap_;
  std::vector<float> new_normals_;  // scratch: of the plan's new faces, 3 each
  Reduction result_;
};

}  // namespace merlin::render
