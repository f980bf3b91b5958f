// Port: where a finished frame goes. Shared memory and PNG files are the kinds here; a new kind is
// a class and a row in output_kinds.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"

namespace merlin::render {

struct FrameInfo {
  std::uint64_t sequence = 0;  // +1 a frame
  Timestamp finished{};        // when its last pixel was drawn
  std::uint32_t cost = 0;      // of its detail, in the content's unit: a model's triangles
  bool full_detail = false;
};

// Picture that is sent to an output.
struct Signal {
  int width = 0, height = 0;               // [px]
  std::span<const std::uint8_t> pixels{};  // RGBA, rows from top to bottom, no padding
};

// Thread-bound to the wall's thread, but for mend().
class Output {
 public:
  virtual ~Output() = default;

  // Takes the frame; copies what it keeps. Bounded: never waits for a reader, an encoder or a disk;
  // an output that is slow has a thread of its own. Returns when the frame was or will be shown;
  // nothing where it was left out, since the output has a pace of its own. Errors: why the frame,
  // or one that was taken before it, is not shown; the next frame is tried again.
  virtual Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo& info) = 0;

  // Once a second, from any thread: makes again what others have removed. Returns what it did, for
  // the log; empty for nothing. Errors: what cannot be made again.
  virtual Result<std::string> mend() { return std::string(); }
};

}  // namespace merlin::render
