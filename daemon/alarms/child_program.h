// ChildProgram: a program that gets a text as its input and has a limited time.
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

// Thread-bound. Waits in start(), until the program is loaded, and in the destructor, which ends
// it.
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

  // Returns nothing while the program runs; then, once, a sentence about how it ended, empty if
  // with status 0. After the deadline, kills it and all processes that it started, except one in a
  // session of its own (setsid), which no signal to the group reaches.
  std::optional<std::string> ended(Timestamp now);

  // The program's output so far, to standard output or error: the lines of the first kMostKept
  // bytes, each safe to print; then, if there was more, how many bytes were left out.
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
  std::string kept_;          // of its output
  std::size_t left_out_ = 0;  // bytes of it
};

}  // namespace merlin::alarms
