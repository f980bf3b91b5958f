// Work: the number of threads of a processing step, and the callback for its progress.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

#include "daemon/base/blocks.h"

namespace merlin::render::range {

struct Work {
  unsigned threads = 1;
  // Progress callback, called on the caller's thread with the share of the step that is done, 0..1;
  // may be empty.
  std::function<void(double)> progress{};
};

// Returns the work for a part of a step: the part's progress 0..1 is reported as the shares `from`
// to `to` of the step.
inline Work partOf(const Work& work, double from, double to) {
  if (!work.progress) return work;
  return {work.threads, [progress = work.progress, from, to](double share) {
            progress(from + share * (to - from));
          }};
}

// Calls row(0) .. row(rows - 1), each once, on the threads of `work`.
template <typename Row>
void forRows(const Work& work, std::size_t rows, const Row& row) {
  const std::size_t in_a_block = std::max(std::size_t{1}, std::min(std::size_t{16}, rows / 16));
  const std::size_t blocks = (rows + in_a_block - 1) / in_a_block;
  forBlocks(
      work.threads, blocks,
      [&](std::size_t block) {
        const std::size_t end = std::min(rows, (block + 1) * in_a_block);
        for (std::size_t r = block * in_a_block; r < end; ++r) row(r);
      },
      [&](std::size_t done) {
        if (work.progress) work.progress(static_cast<double>(done) / static_cast<double>(blocks));
        return true;
      });
}

}  // namespace merlin::render::range
