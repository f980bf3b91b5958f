// The shared-memory framebuffer: its writer, in the daemon, and its reader, which `merlin snapshot`
// uses.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/shared_memory.h"
#include "render/out/output.h"
#include "render/out/picture/picture_digest.h"
#include "render/out/shared_frame_layout.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::out {

class SharedFrameOutput final : public Output {
 public:
  // Creates the shared memory `name`, e.g. "/merlin-framebuffer". `clock` outlives this. Errors:
  // kUnsupported (more tiles than the framebuffer can describe), kBusy (a running daemon owns it),
  // kIo.
  // The writer does not rely on the segment's content afterwards, since other programs of the same
  // user may write to it.
  static Result<std::unique_ptr<SharedFrameOutput>> make(const std::string& name,
                                                         const tiles::TilePlan& plan,
                                                         std::uint64_t generation,
                                                         const Clock& clock);

  // REQUIRES: the signal has the size of the plan's frame.
  Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo& info) override;

  // readBack() opens the segment by its name, as any other process does, and reads its newest
  // frame; kForeign if another daemon has created it. Errors: those of SharedFrameReader.
  bool canReadBack() const override { return true; }
  Result<std::vector<DisplayReading>> readBack() override;

  // Calls SharedMemory::mend(); present() waits until it returns.
  Result<std::string> mend() override;

 private:
  SharedFrameOutput(std::string name, SharedMemory memory, std::size_t frame_bytes,
                    const Clock& clock)
      : name_(std::move(name)),
        memory_(std::move(memory)),
        frame_bytes_(frame_bytes),
        clock_(clock) {}
  framebuffer::Header& header() { return *reinterpret_cast<framebuffer::Header*>(memory_.data()); }

  const std::string name_;
  std::uint64_t generation_ = 0;
  std::mutex mutex_;  // makes present() and mend() mutually exclusive
  SharedMemory memory_;
  std::size_t frame_bytes_;
  const Clock& clock_;
  std::uint32_t next_ = 0;
};

// A copy of the newest frame, with what is needed to cut it into tiles.
struct CapturedFrame {
  int width = 0, height = 0, wall_width = 0, wall_height = 0;
  std::vector<framebuffer::TileRectangle> tiles;
  std::vector<std::uint8_t> pixels;  // RGBA, rows from top to bottom
  FrameInfo info;
};

// Maps a framebuffer for a program that copies many of its frames. Thread-bound.
class SharedFrameReader {
 public:
  // `from`: whose shared memory is accepted. Errors: kNotFound (no daemon has created it), kIo,
  // kMalformed (not a MERLIN framebuffer, or truncated), kUnsupported (another version).
  static Result<SharedFrameReader> open(const std::string& name,
                                        SharedMemory::From from = SharedMemory::From::kAnyone);

  // Returns the generation of the daemon that created the segment; the headers of that daemon's
  // other segments have the same number.
  std::uint64_t generation() const noexcept { return checked().generation; }
  // Returns the number of the newest frame; 0 if there is none, or if it is just being replaced.
  std::uint64_t newest() const noexcept;
  // Copies the newest frame into `frame` and reuses its memory. Errors: kTimeout (no frame yet, or
  // the writer overwrote the buffer during every attempt).
  Result<Ok> copy(CapturedFrame& frame) const;
  // Returns the newest frame's digest, without copying the frame. Errors: those of copy().
  Result<PictureDigest> digest() const;

 private:
  SharedFrameReader(std::string name, SharedMemory memory);
  const framebuffer::Header& checked() const noexcept {
    return *reinterpret_cast<const framebuffer::Header*>(header_.data());
  }

  std::string name_;
  SharedMemory memory_;
  // A copy of the header, made before it was checked: other programs may change the original.
  alignas(framebuffer::Header) std::array<std::byte, sizeof(framebuffer::Header)> header_;
};

// Copies the newest frame. `from`: whose shared memory is accepted. Errors: kNotFound (no daemon
// has created it), kIo, kMalformed (not a MERLIN framebuffer, or truncated), kUnsupported (another
// version), kTimeout (no frame yet, or the writer overwrote the buffer during every attempt).
Result<CapturedFrame> captureFrame(const std::string& name,
                                   SharedMemory::From from = SharedMemory::From::kAnyone);

// Returns the wall's picture: the wall's tiles of `frame`, each at its place; pixels without a tile
// are 0. Its pixels are empty if there is no wall tile, or if it would have more than
// kMostWallPixels.
inline constexpr std::size_t kMostWallPixels = std::size_t{1} << 28;
CapturedFrame wallPicture(const CapturedFrame& frame);

}  // namespace merlin::render::out
