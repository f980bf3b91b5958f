// SnapshotWriter: frames as PNG files in a folder, when somebody asks by hand; on a thread of its
// own, with what `merlin snapshot` does.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "daemon/base/result.h"

namespace merlin::wall {

// Thread-safe.
class SnapshotWriter {
 public:
  // `framebuffer`: as "/merlin-framebuffer". The folder is made when it is needed.
  SnapshotWriter(std::string framebuffer, std::string folder);
  ~SnapshotWriter();  // what was asked for is still written
  SnapshotWriter(const SnapshotWriter&) = delete;
  SnapshotWriter& operator=(const SnapshotWriter&) = delete;

  // Asks for the newest frame; returns at once. Asked again before it is written, it is one file.
  // What became of it is logged.
  void take();

  // Writes the newest frame now: FOLDER/merlin-DATE-TIME-frame-N.png; returns its path. Errors:
  // captureFrame()'s and writePng()'s, kIo where the folder cannot be made.
  Result<std::string> write() const;

 private:
  void loop(const std::stop_token& stop);

  std::string framebuffer_, folder_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  bool asked_ = false;
  std::jthread thread_;
};

}  // namespace merlin::wall
