// Manages the processes that `merlind --emulate` starts: `merlin emulate DEVICE --link PATH`, one
// per device, so that each can be killed separately.
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
  ~EmulatorChildren();  // ends the processes

  // Starts a process for each device that has an emulator, and sets the device's port in `settings`
  // to the link to its pseudo-terminal: a port pty:PATH is kept, any other is replaced by a path in
  // the run directory. Other devices are read as configured. REQUIRES: no thread has been started.
  // Errors: kIo.
  static Result<EmulatorChildren> start(Settings& settings, const std::string& run_directory);

  struct Emulated {
    std::string device, driver;  // the device's name, and the driver that is emulated
  };
  // Returns the devices whose emulator process has ended since the last call.
  std::vector<Emulated> takeEnded();

 private:
  struct Child {
    Emulated emulated;
    pid_t pid = -1;
  };
  std::vector<Child> children_;
};

}  // namespace merlin
