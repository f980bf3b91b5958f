// The master side of a Linux pseudo-terminal, on which an emulator serves a `pty:` port.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::io {

// One pseudo-terminal in raw mode, and a symbolic link to its slave. Thread-bound.
class PtyMaster {
 public:
  // Creates the symbolic link `link`; an existing link is replaced atomically, any other file at
  // this path is an error. If `link` is empty, none is created. Errors: kIo.
  static Result<PtyMaster> open(const std::string& link);

  PtyMaster(PtyMaster&& other) noexcept;
  PtyMaster& operator=(PtyMaster&&) = delete;
  PtyMaster(const PtyMaster&) = delete;
  PtyMaster& operator=(const PtyMaster&) = delete;
  ~PtyMaster();  // removes the link if it is still ours

  int fd() const noexcept { return master_.get(); }  // non-blocking
  const std::string& slavePath() const noexcept { return slave_path_; }

  // Returns the speed [baud] that the program on the slave side has set; 0 if this speed is not
  // supported.
  int baud() const noexcept;

 private:
  PtyMaster(UniqueFd master, UniqueFd slave, std::string slave_path, std::string link)
      : master_(std::move(master)),
        slave_(std::move(slave)),
        slave_path_(std::move(slave_path)),
        link_(std::move(link)) {}

  UniqueFd master_;
  UniqueFd slave_;  // kept open, so that the master sees no hang-up while no program has it open
  std::string slave_path_;
  std::string link_;
};

}  // namespace merlin::io
