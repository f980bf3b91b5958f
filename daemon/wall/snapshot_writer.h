// SnapshotWriter: saves frames as PNG files in a folder when a person requests a snapshot by a
// bound input, the panel or the command `snapshot`. It works on its own thread and reads the frame
// from shared memory, as `merlin snapshot` does.
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

// Writes the frame as a PNG file with the next name of `files`, removes the oldest files beyond
// their maximum number, and returns the path. Errors: those of writePng() and DatedFiles::next().
Result<std::string> saveFrame(const render::out::CapturedFrame& frame, const DatedFiles& files);

// Thread-safe.
class SnapshotWriter {
 public:
  // `framebuffer`: name of the shared memory with the frame, such as "/merlin-framebuffer".
  // `files`: where images are saved and how many are kept. `watch` must outlive this object.
  SnapshotWriter(std::string framebuffer, DatedFiles files, ThreadWatch& watch);
  ~SnapshotWriter();  // a frame that was requested is still written
  SnapshotWriter(const SnapshotWriter&) = delete;
  SnapshotWriter& operator=(const SnapshotWriter&) = delete;

  // Requests that the newest frame is written; returns at once. Several requests before the frame
  // is written result in one file. The path or the error is logged.
  void take();

  // Returns the number of files that take() has caused to be written.
  std::uint32_t written() const noexcept { return written_; }

  // Writes the newest frame on the calling thread and returns the path of the file. Errors: those
  // of captureFrame() and saveFrame().
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
