#include "daemon/base/process_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

namespace merlin {
namespace {

// Returns the address space that the limit (ulimit -v) still allows [bytes], less an eighth for
// addresses that the allocator and threads reserve but do not use. Returns a very large number if
// there is no limit.
std::size_t freeAddresses() {
  rlimit limit{};
  std::size_t pages = 0;
  std::ifstream used("/proc/self/statm");
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || !(used >> pages))
    return std::numeric_limits<std::size_t>::max();
  const std::size_t taken = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return limit.rlim_cur > taken ? (limit.rlim_cur - taken) / 8 * 7 : 0;
}

}  // namespace

std::optional<std::size_t> availableMemory() {
  std::ifstream info("/proc/meminfo");
  for (std::string word; info >> word;) {
    std::size_t kib = 0;
    if (word == "MemAvailable:" && info >> kib) return kib * 1024;
  }
  return std::nullopt;
}

std::size_t freeMemory() {
  const auto available = availableMemory();
  return available ? std::min(*available / 16 * 15, freeAddresses()) : freeAddresses();
}

std::size_t peakMemory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace merlin
