#include "drivers/io/unix_stream.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "daemon/base/unique_fd.h"
#include "drivers/io/fd_stream.h"
#include "drivers/io/open_error.h"

namespace merlin::io {

Result<std::unique_ptr<ByteStream>> openUnix(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    return Error{Errc::kInvalidArgument, fmt::format("{}: a socket's path may have {} characters",
                                                     path, sizeof address.sun_path - 1)};
  }
  std::memcpy(address.sun_path, path.c_str(), path.size());
  UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!fd.valid()) return openError(path, errno);
  // A socket that does not block is connected at once, or refused while its queue is full.
  if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return openError(path, errno);
  const int raw = fd.get();
  auto owner = std::make_shared<UniqueFd>(std::move(fd));  // shared: std::function must copy
  return std::unique_ptr<ByteStream>(std::make_unique<FdStream>(raw, [owner] { owner->reset(); }));
}

}  // namespace merlin::io
