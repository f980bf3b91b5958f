// ProgramRestart: starts this program again, in the same process.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin {

class ProgramRestart {
 public:
  // Remembers the arguments and the environment. To be made before anything changes them.
  ProgramRestart(int argc, char** argv);

  // Executes the program anew, as it was started. The process id stays, so that a service manager
  // sees no end of the service; all open files are closed except standard input, output and error.
  // `kept`: files that the new program takes over, by name, as it does those of systemd's
  // descriptor store (KeptBySystemd). Returns only if the program cannot be started: kIo. REQUIRES:
  // everything that needs an orderly end has ended, since all other threads just stop.
  Error now(const std::vector<std::pair<std::string, UniqueFd>>& kept) const;

 private:
  std::vector<std::string> arguments_, environment_;
};

}  // namespace merlin
