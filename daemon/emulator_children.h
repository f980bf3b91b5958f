// The processes that `merlind --emulate` starts: `merlin emulate DEVICE --link PATH`, one a device,
// so that each can be killed alone.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

#include "config/settings.h"
#include "daemon/base/result.h"

namespace merlin {

class EmulatorChildren {
 public:
  EmulatorChildren() = default;
  EmulatorChildren(EmulatorChildren&& other) noexcept
      : children_(std::exchange(other.children_, {})) {}
  EmulatorChildren& operator=(EmulatorChildren&&) = delete;
  EmulatorChildren(const EmulatorChildren&) = delete;
  EmulatorChildren& operator=(const EmulatorChildren&) = delete;
  ~EmulatorChildren();  // ends them

  // Starts one for each device and sets `settings`' ports to their lines: where a port is a pty:
  // its path, else one in the run directory. REQUIRES: no thread has been started. Errors: kIo.
  static Result<EmulatorChildren> start(Settings& settings, const std::string& run_directory);

  // Names of children that have ended since the last call.
  std::vector<std::string> takeEnded();

 private:
  struct Child {
    std::string device;
    pid_t pid;
  };
  std::vector<Child> children_;
};

}  // namespace merlin
