#include "tests/bench/reduction/measure.h"

#include <chrono>
#include <fstream>

#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>

namespace merlin::bench {
namespace {

// Returns the value of a line "KEY:   1234 kB" in /proc/self/status, in bytes.
std::size_t statusBytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(key + ":", 0) == 0) return std::stoul(line.substr(key.size() + 1)) * 1024;
  }
  return 0;
}

// Resets the kernel's peak of this process's memory; the peak from getrusage() would include the
// loading of the file.
void forgetPeak() { std::ofstream("/proc/self/clear_refs") << 5; }

double cpuSeconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

Cost measure(const std::function<void()>& work) {
  ::malloc_trim(0);
  forgetPeak();
  const std::size_t before = statusBytes("VmRSS");
  const double cpu = cpuSeconds();
  const auto began = std::chrono::steady_clock::now();
  work();
  const auto ended = std::chrono::steady_clock::now();
  Cost cost;
  cost.cpu_s = cpuSeconds() - cpu;
  cost.wall_s = std::chrono::duration<double>(ended - began).count();
  const std::size_t peak = statusBytes("VmHWM");
  cost.memory_bytes = peak > before ? peak - before : 0;
  return cost;
}

std::string json(const Cost& cost) {
  return fmt::format(R"("seconds": {:.6f}, "cpu_seconds": {:.6f}, "memory_bytes": {})", cost.wall_s,
                     cost.cpu_s, cost.memory_bytes);
}

}  // namespace merlin::bench
