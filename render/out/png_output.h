// PngOutput: writes the newest frame to a PNG file at intervals, encoded on its own thread.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/watched_thread.h"
#include "render/out/output.h"

namespace merlin::render::out {

// A frame that arrives before the interval is over, or while the last one is still being written,
// is skipped, so the wall never waits for a disk; wantsFrame() then asks for a frame once the
// interval is over. present() returns a write error until a file is written successfully.
class PngOutput final : public Output {
 public:
  // Writes RGBA pixels to the file `path`. Errors: those of image::writePng().
  using Write = std::function<Result<Ok>(const std::string& path, int width, int height,
                                         std::span<const std::uint8_t> pixels)>;

  // `interval_s`: minimum time between two files. `watch` outlives this.
  PngOutput(std::string path, double interval_s, ThreadWatch& watch);
  // Writes files by the function `write`, which is called on the output's thread.
  PngOutput(std::string path, double interval_s, ThreadWatch& watch, Write write);
  ~PngOutput() override;
  PngOutput(const PngOutput&) = delete;
  PngOutput& operator=(const PngOutput&) = delete;

  bool mayTake(const FrameInfo& info) const override;
  bool wantsFrame(Timestamp now) const override;
  // A frame counts as shown when it is accepted, not when its file is written.
  Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo& info) override;

 private:
  void encodeLoop(const std::stop_token& stop, Progress& progress);

  std::string path_;
  Write write_;
  double interval_s_;
  std::atomic<Timestamp> last_{Timestamp{}};
  std::atomic<bool> skipped_ = false;  // true: the newest frame was skipped, so the file is older
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<std::uint8_t> waiting_;  // pixels to be written; empty: none
  int width_ = 0, height_ = 0;         // of waiting_ [px]
  std::optional<Error> fault_;         // error of writing the last file; nothing: it was written
  WatchedThread thread_;
};

}  // namespace merlin::render::out
