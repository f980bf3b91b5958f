#include "daemon/wall/frame_tracer.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace merlin::wall {
namespace {

constexpr std::size_t kMostRunOver = 200;  // fewer than the 256 entries of the trace

// Converts a time within a frame to 32-bit nanoseconds; times above 4.29 s are clamped.
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
  frames_.resize(1);
  left_out_ = false;
  frame() = {};
  frame().begin_ns = toNanoseconds(at);
  frame().deadline_ns = toNanoseconds(deadline);
  frame().period = periods_++;
  frame().moving = moving ? 1 : 0;
}

void FrameTracer::add(shm::StepKind kind, Timestamp from, Timestamp to, std::uint16_t tile) {
  shm::FrameTrace& now = frame();
  if (now.count == std::size(now.steps)) return;
  const Timestamp begin = fromNanoseconds(now.begin_ns);
  now.steps[now.count++] = {clampedNs(from - begin), clampedNs(to - from), kind, tile};
}

void FrameTracer::add(std::span<const render::frame::FrameStep> steps) {
  for (const render::frame::FrameStep& s : steps)
    add(inSharedMemory(s.kind), s.begin, s.end, s.tile);
}

void FrameTracer::runOver(Timestamp begin, Timestamp deadline) {
  if (frames_.size() > kMostRunOver) frames_.erase(frames_.begin() + 1);
  shm::FrameTrace& missed = frames_.emplace_back();
  missed.begin_ns = toNanoseconds(begin);
  missed.deadline_ns = toNanoseconds(deadline);
  missed.period = periods_++;
  missed.moving = missed.late = 1;
}

void FrameTracer::end(Timestamp at, std::uint32_t cost) {
  const std::int64_t at_ns = toNanoseconds(at);
  frame().late = frame().moving && (left_out_ || at_ns > frame().deadline_ns) ? 1 : 0;
  for (shm::FrameTrace& f : frames_) {
    f.end_ns = f.late ? std::max(at_ns, f.deadline_ns + 1) : at_ns;
    f.cost = cost;
  }
}

}  // namespace merlin::wall
