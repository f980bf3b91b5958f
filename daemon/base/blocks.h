// Blocks: work cut into numbered pieces that several threads do.
#pragma once

#include <cstddef>
#include <functional>

namespace merlin {

// Calls work(0) .. work(blocks - 1), each once, on `threads` threads, the caller's among them;
// what they write must not overlap, and then does not depend on the number of threads. `goOn` is
// called on the caller's thread with how many are done; once it says false no block is begun.
// Returns whether all were done. What `work` throws comes out here, after all threads have ended.
// REQUIRES: threads > 0.
bool forBlocks(unsigned threads, std::size_t blocks, const std::function<void(std::size_t)>& work,
               const std::function<bool(std::size_t)>& goOn = {});

// `wanted`, or for 0 as many as the machine runs at once.
unsigned threadsOr(unsigned wanted);

}  // namespace merlin
