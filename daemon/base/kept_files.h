// Port: open files that outlive this process, so that the next one of this service goes on with
// them: a graphics card keeps showing its displays' last picture for as long as somebody has it
// open. Implemented by KeptBySystemd.
#pragma once

#include <string>

#include "daemon/base/unique_fd.h"

namespace merlin {

// Thread-safe.
class KeptFiles {
 public:
  virtual ~KeptFiles() = default;

  // The file that the process before this one kept under this name, once; invalid if there is none.
  virtual UniqueFd take(const std::string& name) = 0;

  // Keeps the file under this name, instead of one that was kept before, until forget() or until
  // the service is stopped. False if nobody would keep it.
  virtual bool keep(const std::string& name, int fd) = 0;
  virtual void forget(const std::string& name) = 0;
};

}  // namespace merlin
