// Port: where finished frames go. Implemented here by shared memory and PNG; screens will follow.
#pragma once

#include <cstdint>
#include <span>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"

namespace merlin::render {

struct FrameInfo {
  std::uint64_t sequence = 0;   // +1 a frame
  Timestamp finished{};         // when its last pixel was drawn
  std::uint32_t triangles = 0;  // of the model, as drawn in each tile
  bool full_detail = false;
};

// Thread-bound to the wall's thread.
class FrameSink {
 public:
  virtual ~FrameSink() = default;

  // Takes the frame: RGBA bytes, rows from top to bottom, no padding, of the size that the sink was
  // made for. Copies what it keeps. Bounded: never waits for a reader, an encoder or a disk.
  virtual void present(std::span<const std::uint8_t> pixels, const FrameInfo& info) = 0;
};

}  // namespace merlin::render
