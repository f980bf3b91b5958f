// PngOutput: the newest frame as a PNG file, now and then, encoded on a thread of its own.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/watched_thread.h"
#include "render/out/output.h"

namespace merlin::render {

// A frame that comes before the interval is over, or while the last one is still being written, is
// left out: the wall never waits for a disk. An error of writing is returned by present() until a
// file is written again.
class PngOutput final : public Output {
 public:
  // `interval_s`: between two files, at least. `watch` outlives this.
  PngOutput(std::string path, double interval_s, ThreadWatch& watch);
  ~PngOutput() override;
  PngOutput(const PngOutput&) = delete;
  PngOutput& operator=(const PngOutput&) = delete;

  // A frame that is taken counts as shown when it is taken.
  Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo& info) override;

 private:
  void encodeLoop(const std::stop_token& stop, Progress& progress);

  std::string path_;
  double interval_s_;
  Timestamp last_{};
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<std::uint8_t> waiting_;  // empty: nothing to do
  int width_ = 0, height_ = 0;         // of waiting_ [px]
  std::optional<Error> fault_;         // of the last file
  WatchedThread thread_;
};

}  // namespace merlin::render
