// CrashFrame: writes to a file the last frame of a wall's process that was killed or crashed.
#pragma once

#include <optional>
#include <string>

#include "daemon/base/dated_files.h"
#include "daemon/base/watched_thread.h"
#include "render/out/shared_frame.h"

namespace merlin::wall {

// The newest frame in the shared memory of this name ("/merlin-framebuffer"), if its process is
// gone without having removed it. To be called before this process makes its own under that name,
// which replaces it. Takes as long as copying the frame.
std::optional<render::out::CapturedFrame> frameOfCrash(const std::string& name);

class CrashFrame {
 public:
  // Writes the frame as a PNG file, once, on a thread that gives way to all others; the log says
  // where it is. `watch` must outlive this.
  CrashFrame(render::out::CapturedFrame frame, DatedFiles files, ThreadWatch& watch);
  ~CrashFrame();
  CrashFrame(const CrashFrame&) = delete;
  CrashFrame& operator=(const CrashFrame&) = delete;

 private:
  void write(Progress& progress);

  render::out::CapturedFrame frame_;
  DatedFiles files_;
  WatchedThread thread_;  // declared last: it uses all others
};

}  // namespace merlin::wall
