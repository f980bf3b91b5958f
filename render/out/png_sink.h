// PngFrameSink: the newest frame as a PNG file, now and then, encoded on a thread of its own.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/watched_thread.h"
#include "render/out/frame_sink.h"
#include "render/out/settings.h"

namespace merlin::render {

// A frame that comes while the last one is still being written is left out: the wall never waits
// for a disk. What went wrong last is told by error().
class PngFrameSink final : public FrameSink {
 public:
  // `watch` outlives this.
  PngFrameSink(PngSinkSettings settings, int width, int height, ThreadWatch& watch);
  ~PngFrameSink() override;
  PngFrameSink(const PngFrameSink&) = delete;
  PngFrameSink& operator=(const PngFrameSink&) = delete;

  void present(std::span<const std::uint8_t> pixels, const FrameInfo& info) override;

  // Empty while all is well. Thread-safe.
  std::string error() const;

 private:
  void encodeLoop(const std::stop_token& stop, Progress& progress);

  PngSinkSettings settings_;
  int width_, height_;
  Timestamp last_{};
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<std::uint8_t> waiting_;  // empty: nothing to do
  std::string error_;
  WatchedThread thread_;
};

}  // namespace merlin::render
