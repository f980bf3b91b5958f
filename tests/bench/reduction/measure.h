// Measurements that all programs of the reduction benchmark share: wall and CPU seconds of a piece
// of work, and the growth of memory during that work.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace merlin::bench {

struct Cost {
  double wall_s = 0;
  double cpu_s = 0;              // user and system, all threads of this process
  std::size_t memory_bytes = 0;  // peak resident size during the work, minus the size before it
};

// Runs `work` once. First returns freed pages to the system, so that memory left from loading
// cannot hide what the work needs.
Cost measure(const std::function<void()>& work);

// Members of a JSON object, without the braces: "seconds": .., "cpu_seconds": .., "memory_bytes":
// ..
std::string json(const Cost& cost);

}  // namespace merlin::bench
