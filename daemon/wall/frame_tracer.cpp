#include "daemon/wall/frame_tracer.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace merlin::wall {
namespace {

// Times within a frame are 32-bit nanoseconds; those above 4.29 s are clamped.
std::uint32_t clampedNs(Duration d) {
  constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(d.count(), 0, kMost));
}

shm::StepKind inSharedMemory(render::frame::FrameStep::Kind kind) {
  using Kind = render::frame::FrameStep::Kind;
  switch (kind) {
    case Kind::kChoose: return shm::StepKind::kCut;
    case Kind::kUpload: return shm::StepKind::kUpload;
    case Kind::kReadBack: return shm::StepKind::kReadBack;
    case Kind::kRefine: return shm::StepKind::kRefine;
    case Kind::kDraw: break;
  }
  return shm::StepKind::kDraw;
}

}  // namespace

void FrameTracer::begin(Timestamp at, Timestamp deadline, bool moving) {
  frame_ = {};
  frame_.begin_ns = toNanoseconds(at);
  frame_.deadline_ns = toNanoseconds(deadline);
  frame_.period = periods_++;
  frame_.moving = moving ? 1 : 0;
}

void FrameTracer::add(shm::StepKind kind, Timestamp from, Timestamp to, std::uint16_t tile) {
  if (frame_.count == std::size(frame_.steps)) return;
  const Timestamp begin = fromNanoseconds(frame_.begin_ns);
  frame_.steps[frame_.count++] = {clampedNs(from - begin), clampedNs(to - from), kind, tile};
}

void FrameTracer::add(std::span<const render::frame::FrameStep> steps) {
  for (const render::frame::FrameStep& s : steps)
    add(inSharedMemory(s.kind), s.begin, s.end, s.tile);
}

void FrameTracer::end(Timestamp at, std::uint32_t cost) {
  frame_.end_ns = toNanoseconds(at);
  frame_.late = frame_.moving && frame_.end_ns > frame_.deadline_ns ? 1 : 0;
  frame_.cost = cost;
}

}  // namespace merlin::wall
