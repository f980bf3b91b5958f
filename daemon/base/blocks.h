// Blocks: work cut into numbered pieces that several threads do.
#pragma once

#include <algorithm>
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

// Calls work(i) for each i of [0, count), in blocks, as above.
template <typename Work>
void forEach(unsigned threads, std::size_t count, const Work& work) {
  constexpr std::size_t kBlock = 1 << 14;
  forBlocks(threads, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
    const std::size_t end = std::min(count, (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i) work(i);
  });
}

// `wanted`, or for 0 as many as the machine runs at once.
unsigned threadsOr(unsigned wanted);

}  // namespace merlin
