// DatedFiles: files of one kind in a folder, each named by the time when it was made; the oldest
// are removed.
#pragma once

#include <ctime>
#include <string>

#include "daemon/base/result.h"

namespace merlin {

// NAME-20261123T045500Z.ENDING, in UTC; what is made in the same second has -2, -3 ... behind the
// time. So neither a restart nor another daemon with another NAME replaces a file. Not
// thread-safe where two threads make files of one name.
class DatedFiles {
 public:
  // `most`: files kept, at least 1.
  DatedFiles(std::string folder, std::string name, std::string ending, std::size_t most)
      : folder_(std::move(folder)),
        name_(std::move(name)),
        ending_(std::move(ending)),
        most_(most) {}

  // The path of a file that is not there yet. Makes the folder. Errors: kIo, kNotFound.
  Result<std::string> next(std::time_t now) const;

  // Once the new file is whole: removes the oldest regular files of exactly this form, until `most`
  // are left. One that is later than `now` was made by a clock that was wrong, and counts as old.
  // What cannot be removed stays. O(files in the folder).
  void removeOldest(std::time_t now) const;

 private:
  std::string folder_, name_, ending_;
  std::size_t most_;
};

}  // namespace merlin
