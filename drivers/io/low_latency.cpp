#include "drivers/io/low_latency.h"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <linux/serial.h>
#include <sys/ioctl.h>

namespace merlin::io {

void askForLowLatency(int fd) {
  serial_struct line{};
  if (::ioctl(fd, TIOCGSERIAL, &line) != 0) return;
  line.flags = static_cast<int>(static_cast<unsigned>(line.flags) | ASYNC_LOW_LATENCY);
  (void)::ioctl(fd, TIOCSSERIAL, &line);
}

std::string adapterWarning(const std::string& path, const std::string& sysfs) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path real = fs::canonical(path, error);
  if (error) return {};
  const fs::path timer = fs::path(sysfs) / "class/tty" / real.filename() / "device/latency_timer";
  int milliseconds = 0;
  if (!(std::ifstream(timer) >> milliseconds) || milliseconds <= 1) return {};
  return fmt::format(
      "{}: its USB adapter delays bytes by up to {} ms; to limit this to 1 ms: echo 1 > {}", path,
      milliseconds, timer.string());
}

}  // namespace merlin::io
