// Parallel loops: work in numbered blocks that several threads process.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace merlin {

class ThreadTeam;

// Number of threads of a parallel loop, including the caller's, and the team that provides them. A
// team suits many short loops; without a team each loop starts threads of its own.
struct Threads {
  Threads(unsigned n) : count(n) {}  // NOLINT(google-explicit-constructor): a number is enough
  Threads(unsigned n, ThreadTeam& from) : count(n), team(&from) {}

  unsigned count;
  ThreadTeam* team = nullptr;
};

// Calls work(0) .. work(blocks - 1), each once, on `threads.count` threads. The blocks must not
// write to the same memory; the result then does not depend on the number of threads. `keepGoing`
// is called on the caller's thread with the number of finished blocks; after it returns false no
// further block begins. Returns whether all blocks were done. An exception of `work` is rethrown
// here, after all threads have finished. `work` may call forBlocks() itself: while the team is
// busy, such an inner loop starts threads of its own. REQUIRES: threads.count > 0.
bool forBlocks(Threads threads, std::size_t blocks, const std::function<void(std::size_t)>& work,
               const std::function<bool(std::size_t)>& keepGoing = {});

// Calls work(i) for each i in [0, count), by forBlocks() with blocks of 16384 calls.
template <typename Work>
void forEach(Threads threads, std::size_t count, const Work& work) {
  constexpr std::size_t kBlock = 1 << 14;
  forBlocks(threads, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
    const std::size_t end = std::min(count, (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i) work(i);
  });
}

// Returns `wanted`, or the number of hardware threads if it is 0.
unsigned threadsOr(unsigned wanted);

}  // namespace merlin
