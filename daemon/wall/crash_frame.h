// CrashFrame: writes the last frame of a wall's process that was killed or crashed to a file.
#pragma once

#include <optional>
#include <string>

#include "daemon/base/dated_files.h"
#include "daemon/base/watched_thread.h"
#include "render/out/shared_frame.h"

namespace merlin::wall {

// Returns the newest frame in the shared memory of this name ("/merlin-framebuffer") if the process
// that wrote it has ended without removing the memory; otherwise nothing. To be called before this
// process creates its own memory under this name, which replaces the old one. Cost: copies the
// frame.
std::optional<render::out::CapturedFrame> frameOfCrash(const std::string& name);

class CrashFrame {
 public:
  // Writes the frame as a PNG file, on a thread of the lowest priority, and logs the path of the
  // file. `watch` must outlive this object.
  CrashFrame(render::out::CapturedFrame frame, DatedFiles files, ThreadWatch& watch);
  ~CrashFrame();
  CrashFrame(const CrashFrame&) = delete;
  CrashFrame& operator=(const CrashFrame&) = delete;

 private:
  void write(Progress& progress);

  render::out::CapturedFrame frame_;
  DatedFiles files_;
  WatchedThread thread_;  // declared last, because it uses all other members
};

}  // namespace merlin::wall
