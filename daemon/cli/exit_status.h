// What programs exit with; outside checks rely on it.
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
inline constexpr int kExitFailed = 1;    // while running
inline constexpr int kExitBadInput = 2;  // bad usage or bad input
inline constexpr int kExitBusy = 3;

inline int exitStatus(const Error& error) {
  switch (error.code) {
    case Errc::kNotFound:
    case Errc::kMalformed:
    case Errc::kInvalidArgument:
    case Errc::kUnsupported: return kExitBadInput;
    case Errc::kBusy: return kExitBusy;
    case Errc::kTimeout:
    case Errc::kClosed:
    case Errc::kIo: break;
  }
  return kExitFailed;
}

// What a program's main returns; where something was thrown and nobody caught it (no memory, as a
// rule) one line says so, and `failed` is returned.
template <typename Main>
int guarded(const char* program, Main main, int failed = kExitFailed) noexcept {
  try {
    const int status = main();
    // What was printed may be in a buffer still: a disk that is full shows here.
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
    std::fprintf(stderr, "%s: what it printed could not be written: %s\n", program,
                 std::strerror(errno));
    return std::max(status, failed);  // a check that failed inside stays one
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: ended: no memory is left (a limit as of ulimit -v counts too)\n",
                 program);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: ended: %s\n", program, e.what());
  }
  return failed;
}

}  // namespace merlin
