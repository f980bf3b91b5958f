#include "daemon/rfb/settings.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/base/printable_text.h"
#include "daemon/base/unique_fd.h"

namespace merlin::rfb {
namespace {

constexpr std::size_t kMostPassword = 8;  // VNC's authentication ignores all further characters

bool isLoopback(const std::string& address) {
  in_addr parsed{};
  return ::inet_pton(AF_INET, address.c_str(), &parsed) == 1 && ntohl(parsed.s_addr) >> 24 == 127;
}

Result<UniqueFd> openPrivate(const std::string& path) {
  // O_NONBLOCK: open() must not wait if the path is a pipe.
  UniqueFd fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!fd.valid() || ::fstat(fd.get(), &status) != 0) {
    const Errc code = errno == ENOENT ? Errc::kNotFound : Errc::kIo;
    return Error{code, fmt::format("{}: {}", path, std::strerror(errno))};
  }
  if (!S_ISREG(status.st_mode))
    return Error{Errc::kInvalidArgument, path + ": is not a regular file"};
  if (status.st_uid != ::geteuid() && status.st_uid != 0) {
    return Error{Errc::kInvalidArgument,
                 path + ": belongs to another user, who could change the password (chown)"};
  }
  if ((status.st_mode & 077) != 0) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: other users have access to the password (mode {:04o}); run chmod "
                             "600 {}",
                             path, status.st_mode & 07777, path)};
  }
  return fd;
}

}  // namespace

Result<Listen> parseListen(const std::string& text) {
  const std::size_t colon = std::min(text.rfind(':'), text.size());
  const std::string address = text.substr(0, colon);
  const char* const end = text.data() + text.size();
  const char* const begin = std::min(text.data() + colon + 1, end);
  int port = 0;
  const auto [rest, error] = std::from_chars(begin, end, port);
  in_addr parsed{};
  if (error == std::errc() && rest == end && port >= 0 && port <= 65535 &&
      ::inet_pton(AF_INET, address.c_str(), &parsed) == 1)
    return Listen{address, port};
  return Error{Errc::kInvalidArgument,
               fmt::format("--listen {}: is not ADDRESS:PORT with an IPv4 address, such as "
                           "127.0.0.1:5900",
                           excerpt(text))};
}

Result<Ok> validate(const RfbSettings& settings) {
  if (!settings.password.empty() || isLoopback(settings.listen.address)) return Ok{};
  return Error{
      Errc::kInvalidArgument,
      fmt::format("--listen {}:{}: other machines can reach this address, so a password is "
                  "needed (--password-file FILE); or listen at 127.0.0.1",
                  settings.listen.address, settings.listen.port)};
}

Result<std::string> readPassword(const std::string& path) {
  const auto fd = openPrivate(path);
  if (!fd) return fd.error();
  char bytes[64];
  const ssize_t count = ::read(fd->get(), bytes, sizeof bytes);
  if (count < 0) return Error{Errc::kIo, fmt::format("{}: {}", path, std::strerror(errno))};
  const std::string_view content(bytes, static_cast<std::size_t>(count));
  const std::string_view line = content.substr(0, content.find_first_of("\r\n"));
  const bool printable =
      std::all_of(line.begin(), line.end(), [](char c) { return c > ' ' && c < 0x7F; });
  if (line.empty() || line.size() > kMostPassword || !printable) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: the first line must be a password of 1 to {} characters of ASCII "
                             "without spaces (VNC's authentication ignores what is longer)",
                             path, kMostPassword)};
  }
  return std::string(line);
}

}  // namespace merlin::rfb
