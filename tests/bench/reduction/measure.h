// Measurements that all programs of the reduction benchmark share: wall and CPU seconds of a piece
// of work, and the growth of memory during that work.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace merlin::bench {

struct Cost {
  double wall_s = 0;
  double cpu_s = 0;  // user and system, all threads of this process
  // peak resident size during the work, minus the size before the work
  std::size_t memory_bytes = 0;
};

// Runs `work` once and returns its cost. First returns freed pages to the system; otherwise memory
// left from loading could hide what the work needs.
Cost measure(const std::function<void()>& work);

// Returns the cost as members of a JSON object, without the braces: "seconds": .., "cpu_seconds":
// .., "memory_bytes": ..
std::string json(const Cost& cost);

}  // namespace merlin::bench
