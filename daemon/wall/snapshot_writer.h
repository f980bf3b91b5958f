// SnapshotWriter: frames as PNG files in a folder, when somebody asks by hand; on a thread of its
// own, with what `merlin snapshot` does.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>

#include "daemon/base/dated_files.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"

namespace merlin::wall {

// Thread-safe.
class SnapshotWriter {
 public:
  // `framebuffer`: as "/merlin-framebuffer". `files` says where the pictures go, and how many stay.
  // `watch` outlives this.
  SnapshotWriter(std::string framebuffer, DatedFiles files, ThreadWatch& watch);
  ~SnapshotWriter();  // what was asked for is still written
  SnapshotWriter(const SnapshotWriter&) = delete;
  SnapshotWriter& operator=(const SnapshotWriter&) = delete;

  // Asks for the newest frame; returns at once. If it is asked for again before it is written, one
  // file is written. The result is logged.
  void take();

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
  WatchedThread thread_;
};

}  // namespace merlin::wall
