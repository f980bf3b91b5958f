// The shared-memory framebuffer: its writer in the daemon, the reader that `merlin snapshot` uses.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/shared_memory.h"
#include "render/out/output.h"
#include "render/out/shared_frame_layout.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render {

class SharedFrameOutput final : public Output {
 public:
  // `name` as "/merlin-framebuffer". `clock` outlives this. Errors: kBusy (a living daemon writes
  // it), kIo.
  // Nothing is believed of what lies in it later: its owner's programs may write there.
  static Result<std::unique_ptr<SharedFrameOutput>> make(const std::string& name,
                                                         const TilePlan& plan,
                                                         std::uint64_t generation,
                                                         const Clock& clock);

  // REQUIRES: a signal of the plan's frame.
  Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo& info) override;

  // SharedMemory::mend(). A frame waits for it.
  Result<std::string> mend() override;

 private:
  SharedFrameOutput(SharedMemory memory, std::size_t frame_bytes, const Clock& clock)
      : memory_(std::move(memory)), frame_bytes_(frame_bytes), clock_(clock) {}
  framebuffer::Header& header() { return *reinterpret_cast<framebuffer::Header*>(memory_.data()); }

  std::mutex mutex_;  // between present() and mend()
  SharedMemory memory_;
  std::size_t frame_bytes_;
  const Clock& clock_;
  std::uint32_t next_ = 0;
};

// A copy of the newest frame, with what is needed to cut it up.
struct CapturedFrame {
  int width = 0, height = 0, wall_width = 0, wall_height = 0;
  std::vector<framebuffer::TileRectangle> tiles;
  std::vector<std::uint8_t> pixels;  // RGBA, rows from top to bottom
  FrameInfo info;
};

// `from`: whose frame a daemon believes. Errors: kNotFound (no daemon has it), kIo, kMalformed (not
// one of ours, or cut short), kUnsupported (another version), kTimeout (overtaken by the writer
// each time).
Result<CapturedFrame> captureFrame(const std::string& name,
                                   SharedMemory::From from = SharedMemory::From::kAnyone);

// The wall's picture: the wall tiles side by side. Empty pixels if there is no wall tile.
CapturedFrame wallPicture(const CapturedFrame& frame);

}  // namespace merlin::render
