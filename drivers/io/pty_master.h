// The other side of a `pty:` port: what an emulator serves on. Linux pseudo-terminals.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::io {

// One pseudo-terminal in raw mode, and a symbolic link to its slave. Thread-bound.
class PtyMaster {
 public:
  // `link` is made, or replaced at once if it is a symbolic link; anything else there is an error.
  // An empty `link` makes none. Errors: kIo.
  static Result<PtyMaster> open(const std::string& link);

  PtyMaster(PtyMaster&& other) noexcept;
  PtyMaster& operator=(PtyMaster&&) = delete;
  PtyMaster(const PtyMaster&) = delete;
  PtyMaster& operator=(const PtyMaster&) = delete;
  ~PtyMaster();  // removes the link if it is still ours

  int fd() const noexcept { return master_.get(); }  // non-blocking
  const std::string& slavePath() const noexcept { return slave_path_; }

  // The speed that the program at the other side has set [baud]; 0 if it is none that we know.
  int baud() const noexcept;

 private:
  PtyMaster(UniqueFd master, UniqueFd slave, std::string slave_path, std::string link)
      : master_(std::move(master)),
        slave_(std::move(slave)),
        slave_path_(std::move(slave_path)),
        link_(std::move(link)) {}

  UniqueFd master_;
  UniqueFd slave_;  // kept open, so that the master sees no hang-up while nobody else is there
  std::string slave_path_;
  std::string link_;
};

}  // namespace merlin::io
