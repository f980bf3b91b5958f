// Port: who draws the wall's frames. Implemented by Picture (GL) and by a fake in tests.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include "daemon/base/clock.h"
#include "daemon/shm/layout.h"

namespace merlin::wall {

struct DrawTimes {
  Duration drawing{};  // cut, upload, triangles; where a view was coarser, what it would have been
  Duration fixed{};    // clearing and read-back
  bool gave_way = false;  // the operator's view was coarser, for want of time
};

// Where a painter's time went: the steps of its last draw() or refine(), in order.
struct PaintStep {
  shm::StepKind kind;
  std::uint16_t tile;  // of the plan, where it is one tile's
  Timestamp begin, end;
};

// Thread-bound to the wall's thread.
class Painter {
 public:
  virtual ~Painter() = default;

  // The whole frame at `level` of the dendrogram, if possible by `until`: the wall's tiles come
  // first, and the operator's view gets coarser where they took longer than they used to.
  virtual DrawTimes draw(const Eigen::Isometry3f& T_eye_model, std::size_t level,
                         Timestamp until) = 0;

  // Full detail in slices: beginRefining() once, then refine() until it returns true: the frame is
  // whole, pixels() shows it. refine() draws until about `until`, one slice at least, if there is
  // time for one; a slice takes a few milliseconds. draw() in between abandons it.
  virtual void beginRefining(const Eigen::Isometry3f& T_eye_model) = 0;
  virtual bool refine(Timestamp until) = 0;

  // The same, but for `level` and not full detail: something finer than what moved, soon, where
  // full detail takes long. false, and nothing done, where a painter does not do that.
  virtual bool beginRefiningTo(const Eigen::Isometry3f& /*T_eye_model*/, std::size_t /*level*/) {
    return false;
  }

  // Of what draw() draws from now on: tiles of 1/divisor of their size each way, enlarged. What is
  // refined is whole. 1 until it is told; divisor >= 1. Nothing where a painter cannot.
  virtual void setScale(int /*divisor*/) {}

  // Whether a tile of the wall may show any of it. True where a painter does not know.
  virtual bool sees(const Eigen::Isometry3f& /*T_eye_model*/) const { return true; }

  // For the trace; none where a painter does not say.
  virtual std::span<const PaintStep> steps() const noexcept { return {}; }

  // RGBA, rows from top to bottom, of the plan's frame. Who draws on them puts them back.
  virtual std::span<std::uint8_t> pixels() noexcept = 0;
};

}  // namespace merlin::wall
