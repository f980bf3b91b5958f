// ChildProgram: runs a program that gets a text as its input and has a time limit.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::alarms {

// Whether this process may execute the program now, as far as the file and its first line tell.
// Errors, each a sentence that begins with the path: kNotFound (there is no such file, it is not a
// regular file, it may not be executed, or it is a script whose interpreter is missing).
Result<Ok> checkProgram(const std::string& path);

// Thread-bound. start() waits until the program is loaded; the destructor kills the program and
// waits for its end.
class ChildProgram {
 public:
  // Starts the program `run[0]` with the arguments that follow it, in a process group of its own,
  // with `input` as its standard input. Errors, each a sentence that begins with the program's
  // path: kNotFound (there is no such program, or it cannot be executed, for example a script whose
  // interpreter is missing), kIo. The process may have several threads.
  static Result<ChildProgram> start(const std::vector<std::string>& run, const std::string& input,
                                    Timestamp deadline);
  ChildProgram(ChildProgram&& other) noexcept;
  ChildProgram& operator=(ChildProgram&& other) noexcept;
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;
  ~ChildProgram();

  // Returns nothing while the program runs. After its end returns once how it ended: the rest of a
  // sentence that begins with the program's name, or an empty text for status 0. After the
  // deadline, kills the program and all processes that it started, except a process that has left
  // the process group (setsid), which the signal does not reach.
  std::optional<std::string> ended(Timestamp now);

  // Returns the program's output so far, to standard output and error, as lines that are safe to
  // print: the first kMostKept bytes and, if there was more, a line with the number of bytes left
  // out.
  std::vector<std::string> written() const;
  static constexpr std::size_t kMostKept = 2048;

 private:
  ChildProgram(pid_t pid, UniqueFd output, Timestamp deadline)
      : pid_(pid), output_(std::move(output)), deadline_(deadline) {}
  void kill() noexcept;
  void readOutput();

  pid_t pid_ = -1;  // -1: it has ended
  UniqueFd output_;
  Timestamp deadline_{};
  bool too_long_ = false;
  std::string kept_;          // the first bytes of its output
  std::size_t left_out_ = 0;  // number of its further bytes
};

}  // namespace merlin::alarms
