#include "drivers/io/pty_master.h"

#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <termios.h>

namespace merlin::io {
namespace {

std::string readLink(const std::string& link) {
  char target[PATH_MAX];
  const ssize_t n = ::readlink(link.c_str(), target, sizeof target);
  return n < 0 ? std::string() : std::string(target, static_cast<std::size_t>(n));
}

// Replaces an existing link by rename(), so that the path is never without a link.
Result<Ok> makeLink(const std::string& target, const std::string& link) {
  struct stat status {};
  if (::lstat(link.c_str(), &status) == 0 && !S_ISLNK(status.st_mode)) {
    return Error{Errc::kIo, link + ": exists and is not a symbolic link"};
  }
  const std::string fresh = fmt::format("{}.{}", link, ::getpid());
  ::unlink(fresh.c_str());
  if (::symlink(target.c_str(), fresh.c_str()) != 0 || ::rename(fresh.c_str(), link.c_str()) != 0) {
    return Error{Errc::kIo, fmt::format("{}: {}", link, std::strerror(errno))};
  }
  return Ok{};
}

}  // namespace

Result<PtyMaster> PtyMaster::open(const std::string& link) {
  UniqueFd master(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  char name[128] = "";
  if (!master.valid() || ::grantpt(master.get()) != 0 || ::unlockpt(master.get()) != 0 ||
      ::ptsname_r(master.get(), name, sizeof name) != 0) {
    return Error{Errc::kIo,
                 fmt::format("cannot create a pseudo-terminal: {}", std::strerror(errno))};
  }
  UniqueFd slave(::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios line{};
  if (!slave.valid() || ::tcgetattr(slave.get(), &line) != 0) {
    return Error{Errc::kIo, fmt::format("{}: {}", name, std::strerror(errno))};
  }
  ::cfmakeraw(&line);
  ::tcsetattr(slave.get(), TCSANOW, &line);
  if (!link.empty()) {
    if (const auto made = makeLink(name, link); !made) return made.error();
  }
  return PtyMaster(std::move(master), std::move(slave), name, link);
}

PtyMaster::PtyMaster(PtyMaster&& other) noexcept
    : master_(std::move(other.master_)),
      slave_(std::move(other.slave_)),
      slave_path_(std::move(other.slave_path_)),
      link_(std::exchange(other.link_, {})) {}

PtyMaster::~PtyMaster() {
  if (!link_.empty() && readLink(link_) == slave_path_) ::unlink(link_.c_str());
}

int PtyMaster::baud() const noexcept {
  termios line{};
  if (::tcgetattr(master_.get(), &line) != 0) return 0;
  switch (::cfgetospeed(&line)) {
    case B1200: return 1200;
    case B2400: return 2400;
    case B4800: return 4800;
    case B9600: return 9600;
    case B19200: return 19200;
    case B38400: return 38400;
    case B57600: return 57600;
    case B115200: return 115200;
    default: return 0;
  }
}

}  // namespace merlin::io
