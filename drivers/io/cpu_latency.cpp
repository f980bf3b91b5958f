#include "drivers/io/cpu_latency.h"

#include <cerrno>
#include <cstdint>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>

namespace merlin::io {

Result<UniqueFd> limitCpuLatency(int microseconds, const std::string& device) {
  UniqueFd fd(::open(device.c_str(), O_WRONLY | O_CLOEXEC));
  const std::int32_t limit = microseconds;
  if (fd.valid() && ::write(fd.get(), &limit, sizeof limit) == sizeof limit) return fd;
  const int error = errno;
  const char* hint = error == EACCES ? " (it is root's, as a rule; systemd/README.md has the rule "
                                       "that gives it to a group)"
                     : error == ENOENT ? " (a kernel with CONFIG_CPU_IDLE has it)"
                                       : "";
  return Error{error == ENOENT ? Errc::kNotFound : Errc::kIo,
               fmt::format("{}: {}: idle cores wake as the system has it{}", device,
                           std::strerror(error), hint)};
}

}  // namespace merlin::io
