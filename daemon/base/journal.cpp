#include "daemon/base/journal.h"

#include <cstdint>
#include <cstring>

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

namespace merlin {
namespace {

// Appends a value that contains a line feed. Instead of "=" it begins with a line feed and its
// length in eight bytes, the lowest first.
void addLongValue(std::string& datagram, std::string_view value) {
  datagram += '\n';
  for (int byte = 0; byte < 8; ++byte)
    datagram += static_cast<char>(static_cast<std::uint64_t>(value.size()) >> 8 * byte & 0xFF);
  datagram += value;
}

}  // namespace

bool isJournalStream(int fd, const char* journal_stream) {
  struct stat found {};
  if (journal_stream == nullptr || ::fstat(fd, &found) != 0) return false;
  return fmt::format("{}:{}", found.st_dev, found.st_ino) == journal_stream;
}

std::string journalDatagram(std::span<const JournalField> fields) {
  std::string datagram;
  for (const auto& [name, value] : fields) {
    if (value.empty()) continue;
    datagram += name;
    if (value.find('\n') == std::string_view::npos)
      datagram.append("=").append(value);
    else
      addLongValue(datagram, value);
    datagram += '\n';
  }
  return datagram;
}

Journal::Journal(std::string socket_path)
    : path_(std::move(socket_path)), socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}

bool Journal::send(std::string_view datagram) const {
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  if (path_.size() >= sizeof to.sun_path) return false;
  std::memcpy(to.sun_path, path_.data(), path_.size());
  return ::sendto(socket_.get(), datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                  reinterpret_cast<const sockaddr*>(&to),
                  sizeof to) == static_cast<ssize_t>(datagram.size());
}

}  // namespace merlin
