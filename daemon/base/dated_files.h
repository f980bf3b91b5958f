// DatedFiles: files of one kind in a folder, each named by the time of its creation; the oldest are
// removed.
#pragma once

#include <ctime>
#include <string>

#include "daemon/base/result.h"

namespace merlin {

// A file is named NAME, "-20261123T045500Z" (the time in UTC) and ENDING; further files of the same
// second have -2, -3 ... after the time. So neither a restart nor another daemon with another NAME
// replaces a file. Not thread-safe: no two threads may make files of one NAME.
class DatedFiles {
 public:
  // `ending`: with its dot, such as ".png". `most`: number of files kept, at least 1.
  DatedFiles(std::string folder, std::string name, std::string ending, std::size_t most)
      : folder_(std::move(folder)),
        name_(std::move(name)),
        ending_(std::move(ending)),
        most_(most) {}

  // Returns the path of a file that does not exist yet, named by the time `now`. Creates the
  // folder. Errors: kIo (the folder cannot be created, or all names of this second are taken).
  Result<std::string> next(std::time_t now) const;

  // To be called once the new file is complete: removes the oldest regular files with names of
  // exactly this form until `most` are left. A file whose name has a later time than `now` was
  // named by a wrong clock and counts as the oldest. Files that cannot be removed stay. O(files in
  // the folder).
  void removeOldest(std::time_t now) const;

 private:
  std::string folder_, name_, ending_;
  std::size_t most_;
};

}  // namespace merlin
