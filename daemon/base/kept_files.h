// Port: open files that outlive this process and that the next process of the service takes over.
// For example, a graphics card keeps showing the last picture for as long as some process has it
// open. Implemented by KeptBySystemd.
#pragma once

#include <string>

#include "daemon/base/unique_fd.h"

namespace merlin {

// Thread-safe.
class KeptFiles {
 public:
  virtual ~KeptFiles() = default;

  // Returns the file that the previous process kept under this name; invalid if there is none, and
  // from the second call on.
  virtual UniqueFd take(const std::string& name) = 0;

  // Keeps the file under this name until forget() or until the service is stopped; replaces a file
  // kept under it before. Returns false if the file could not be kept.
  virtual bool keep(const std::string& name, int fd) = 0;
  virtual void forget(const std::string& name) = 0;
};

}  // namespace merlin
