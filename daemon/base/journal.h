// systemd's journal: lines with fields. This code speaks its native protocol itself; libsystemd's
// sd_journal_send() would wait while the journal hangs, and a log must never stop the daemon.
// Source: https://systemd.io/JOURNAL_NATIVE_PROTOCOL
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/base/unique_fd.h"

namespace merlin {

// Name of a field, of the characters A-Z and _, and its value.
using JournalField = std::pair<std::string_view, std::string_view>;

// Whether descriptor `fd` is the stream to the journal. `journal_stream`: the environment variable
// JOURNAL_STREAM, in which systemd puts "DEVICE:INODE" of this stream (systemd.exec(5)); null if it
// is not set.
bool isJournalStream(int fd, const char* journal_stream);

// Returns the fields as a datagram of the protocol, without fields whose value is empty.
std::string journalDatagram(std::span<const JournalField> fields);

// Thread-safe.
class Journal {
 public:
  static constexpr const char* kSocket = "/run/systemd/journal/socket";

  explicit Journal(std::string socket_path = kSocket);
  // Returns whether the journal has taken the datagram. Never waits.
  bool send(std::string_view datagram) const;

 private:
  std::string path_;
  UniqueFd socket_;
};

}  // namespace merlin
