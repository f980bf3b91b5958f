// SnapshotWriter: saves frames as PNG files in a folder when a person requests it, by a bound
// input, the panel or the command snapshot. Works on its own thread and, like `merlin snapshot`,
// reads the frame from shared memory.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>

#include "daemon/base/dated_files.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "render/out/shared_frame.h"

namespace merlin::wall {

// Writes the frame as the next of the files, a PNG, and returns its path. Errors: those of
// writePng() and DatedFiles::next().
Result<std::string> saveFrame(const render::out::CapturedFrame& frame, const DatedFiles& files);

// Thread-safe.
class SnapshotWriter {
 public:
  // `framebuffer`: name of the segment with the frame, such as "/merlin-framebuffer". `files`:
  // where images are saved, and how many are kept. `watch` must outlive this object.
  SnapshotWriter(std::string framebuffer, DatedFiles files, ThreadWatch& watch);
  ~SnapshotWriter();  // a requested frame is still written
  SnapshotWriter(const SnapshotWriter&) = delete;
  SnapshotWriter& operator=(const SnapshotWriter&) = delete;

  // Requests that the newest frame is written; returns at once. Requests that arrive before it is
  // written are merged into one file. The result is logged.
  void take();

  // Number of files that were written.
  std::uint32_t written() const noexcept { return written_; }

  // Writes the newest frame now; returns its path. Errors: captureFrame()'s, writePng()'s and
  // DatedFiles::next()'s.
  Result<std::string> write() const;

 private:
  void loop(const std::stop_token& stop, Progress& progress);

  std::string framebuffer_;
  DatedFiles files_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  bool asked_ = false;
  std::atomic<std::uint32_t> written_{0};
  WatchedThread thread_;
};

}  // namespace merlin::wall
