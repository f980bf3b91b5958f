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
  // Remembers the arguments and the environment. REQUIRES: nothing has changed them yet.
  ProgramRestart(int argc, char** argv);

  // Executes the program again with its original arguments and environment. The process id stays,
  // so that a service manager sees no end of the service; all open files are closed except standard
  // input, output and error. `kept`: files and their names, which the new program takes over like
  // files from systemd's descriptor store (KeptBySystemd). Returns only if the program cannot be
  // started: kIo. REQUIRES: all objects that need an orderly shutdown have been destroyed, since
  // all other threads stop at once.
  Error now(const std::vector<std::pair<std::string, UniqueFd>>& kept) const;

 private:
  std::vector<std::string> arguments_, environment_;
};

}  // namespace merlin
