// Exit status of the programs; scripts outside the project rely on it.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "daemon/base/result.h"

namespace merlin {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;    // failed while running
inline constexpr int kExitBadInput = 2;  // bad usage or bad input
inline constexpr int kExitBusy = 3;      // already running

// Returns the exit status for an error: kExitBadInput, kExitBusy or kExitFailed, by its code.
inline int exitStatus(const Error& error) {
  switch (error.code) {
    case Errc::kNotFound:
    case Errc::kMalformed:
    case Errc::kInvalidArgument:
    case Errc::kUnsupported: return kExitBadInput;
    case Errc::kBusy: return kExitBusy;
    case Errc::kTimeout:
    case Errc::kClosed:
    case Errc::kNoMemory:
    case Errc::kIo: break;
  }
  return kExitFailed;
}

// Runs `main` and returns its exit status. After an uncaught exception (usually bad_alloc), prints
// one line to stderr and returns `failed`. If stdout could not be written, prints one line to
// stderr and returns the greater of `failed` and the status of `main`.
template <typename Main>
int runGuarded(const char* program, Main main, int failed = kExitFailed) noexcept {
  try {
    const int status = main();
    // Output may still be buffered, so that only this flush notices a full disk.
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
    std::fprintf(stderr, "%s: the output could not be written: %s\n", program,
                 std::strerror(errno));
    return std::max(status, failed);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: ended: out of memory (or above a limit such as ulimit -v)\n",
                 program);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: ended: %s\n", program, e.what());
  }
  return failed;
}

}  // namespace merlin
