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
  const char* hint = error == EACCES   ? " (usually only root may write it; systemd/README.md has "
                                         "a udev rule that lets a group do so)"
                     : error == ENOENT ? " (the kernel needs CONFIG_CPU_IDLE)"
                                       : "";
  return Error{error == ENOENT ? Errc::kNotFound : Errc::kIo,
               fmt::format("{}: {}: the wake-up latency of idle cores is not limited{}", device,
                           std::strerror(error), hint)};
}

}  // namespace merlin::io
