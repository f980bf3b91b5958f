// Blocks: work cut into numbered pieces that several threads do.
#pragma once

#include <cstddef>
#include <functional>

namespace merlin::render {

// Told on the caller's thread which share of a piece of work is done, 0..1, and how many points it
// has tested; says whether to go on.
using GoOn = std::function<bool(double share, std::size_t points)>;

// Calls work(0) .. work(blocks - 1), each once, on `threads` threads, the caller's among them;
// what they write must not overlap, and then does not depend on the number of threads. `goOn` is
// called on the caller's thread with how many are done; once it says false no block is begun.
// Returns whether all were done. What `work` throws comes out here, after all threads have ended.
// REQUIRES: threads > 0.
bool forBlocks(unsigned threads, std::size_t blocks, const std::function<void(std::size_t)>& work,
               const std::function<bool(std::size_t)>& goOn);

}  // namespace merlin::render
