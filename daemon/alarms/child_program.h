// ChildProgram: a program that gets a text as its input and has a limited time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::alarms {

// Whether this process may execute the program now. Errors, a sentence that begins with the path:
// kNotFound (there is no such file, it is none, or may not be executed).
Result<Ok> checkProgram(const std::string& path);

// Thread-bound. Never waits, except for the destructor, which ends the program.
class ChildProgram {
 public:
  // Starts the program `run[0]` with the arguments behind it, in a process group of its own, with
  // `input` as its standard input; its output goes where ours goes. Errors: kNotFound (there is no
  // such program, or it cannot be executed), kIo. The process may have several threads.
  static Result<ChildProgram> start(const std::vector<std::string>& run, const std::string& input,
                                    Timestamp deadline);
  ChildProgram(ChildProgram&& other) noexcept;
  ChildProgram& operator=(ChildProgram&& other) noexcept;
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;
  ~ChildProgram();

  // What became of it: nothing while it runs; then once a sentence, empty if it ended with status
  // 0. Ends it and all that it started once the deadline has passed.
  std::optional<std::string> ended(Timestamp now);

 private:
  ChildProgram(pid_t pid, Timestamp deadline) : pid_(pid), deadline_(deadline) {}
  void kill() noexcept;

  pid_t pid_ = -1;  // -1: it has ended
  Timestamp deadline_{};
  bool too_long_ = false;
};

}  // namespace merlin::alarms
