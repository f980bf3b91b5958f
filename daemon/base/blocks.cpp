#include "daemon/base/blocks.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <exception>
#include <optional>
#include <thread>

#include "daemon/base/thread_team.h"

namespace merlin {

bool forBlocks(Threads threads, std::size_t blocks, const std::function<void(std::size_t)>& work,
               const std::function<bool(std::size_t)>& keepGoing) {
  assert(threads.count > 0);
  if (blocks == 0) return true;
  std::atomic<std::size_t> next{0}, done{0};
  std::atomic<bool> cancelled{false};
  std::atomic_flag thrown;
  std::exception_ptr exception;
  const auto doOne = [&] {
    if (cancelled) return false;
    const std::size_t block = next++;
    if (block >= blocks) return false;
    try {
      work(block);
    } catch (...) {  // usually std::bad_alloc
      if (!thrown.test_and_set()) exception = std::current_exception();
      cancelled = true;
      return false;
    }
    ++done;
    return true;
  };
  const std::function<void()> others = [&] {
    while (doOne()) {
    }
  };
  {
    std::optional<ThreadTeam> own;
    const bool theirs = threads.team && threads.team->idle();
    const std::size_t wanted = std::min<std::size_t>(threads.count, blocks);
    const ThreadTeam::Turn turn =
        (theirs ? *threads.team : own.emplace()).start(wanted - 1, others);
    while (doOne()) {
      if (keepGoing && !keepGoing(done)) cancelled = true;
    }
  }
  if (exception) std::rethrow_exception(exception);
  return done == blocks;
}

unsigned threadsOr(unsigned wanted) {
  return wanted > 0 ? wanted : std::max(1U, std::thread::hardware_concurrency());
}

}  // namespace merlin
