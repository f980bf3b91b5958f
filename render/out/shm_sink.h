// The shared-memory framebuffer: its writer in the daemon, the reader that `merlin snapshot` uses.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/base/shared_memory.h"
#include "render/out/frame_sink.h"
#include "render/out/framebuffer_layout.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render {

class ShmFrameSink final : public FrameSink {
 public:
  // `name` as "/merlin-framebuffer". Errors: kBusy (a living daemon writes it), kIo.
  static Result<std::unique_ptr<ShmFrameSink>> make(const std::string& name, const TilePlan& plan,
                                                    std::uint64_t generation);

  void present(std::span<const std::uint8_t> pixels, const FrameInfo& info) override;

 private:
  ShmFrameSink(SharedMemory memory) : memory_(std::move(memory)) {}
  framebuffer::Header& header() { return *reinterpret_cast<framebuffer::Header*>(memory_.data()); }

  SharedMemory memory_;
  std::uint32_t next_ = 0;
};

// A copy of the newest frame, with what is needed to cut it up.
struct CapturedFrame {
  int width = 0, height = 0, wall_width = 0, wall_height = 0;
  std::vector<framebuffer::TileRectangle> tiles;
  std::vector<std::uint8_t> pixels;  // RGBA, rows from top to bottom
  FrameInfo info;
};

// Errors: kNotFound (no daemon has it), kMalformed (not one of ours, or cut short), kUnsupported
// (another version), kTimeout (overtaken by the writer each time).
Result<CapturedFrame> captureFrame(const std::string& name);

// The wall's picture: the wall tiles side by side. Empty pixels if there is no wall tile.
CapturedFrame wallPicture(const CapturedFrame& frame);

}  // namespace merlin::render
