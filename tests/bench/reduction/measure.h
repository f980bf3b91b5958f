// What every program of the reduction benchmark measures in the same way: wall and CPU seconds of
// one piece of work, and how far memory rises above what was there when it began.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace merlin::bench {

struct Cost {
  double wall_s = 0;
  double cpu_s = 0;              // user and system, all threads of this process
  std::size_t memory_bytes = 0;  // highest resident size during the work, less that before it
};

// Runs `work` once. Pages that the process has freed are given back first, so that memory left over
// from loading cannot hide what the work needs.
Cost measure(const std::function<void()>& work);

// Members of a JSON object, without the braces: "seconds": .., "cpu_seconds": .., "memory_bytes":
// ..
std::string json(const Cost& cost);

}  // namespace merlin::bench
