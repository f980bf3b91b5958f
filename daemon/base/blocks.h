// Parallel loops: work in numbered blocks that several threads process.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace merlin {

// Calls work(0) .. work(blocks - 1), each once, on `threads` threads including the caller's. The
// blocks must not write to the same memory; the result then does not depend on the number of
// threads. `goOn` is called on the caller's thread with the number of finished blocks; after it
// returns false no further block begins. Returns whether all blocks were done. An exception of
// `work` is rethrown here, after all threads have finished. REQUIRES: threads > 0.
bool forBlocks(unsigned threads, std::size_t blocks, const std::function<void(std::size_t)>& work,
               const std::function<bool(std::size_t)>& goOn = {});

// Calls work(i) for each i of [0, count), in blocks of 16384, with forBlocks().
template <typename Work>
void forEach(unsigned threads, std::size_t count, const Work& work) {
  constexpr std::size_t kBlock = 1 << 14;
  forBlocks(threads, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
    const std::size_t end = std::min(count, (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i) work(i);
  });
}

// Returns `wanted`, or the number of hardware threads if it is 0.
unsigned threadsOr(unsigned wanted);

}  // namespace merlin
