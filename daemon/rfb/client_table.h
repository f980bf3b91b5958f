// ClientTable: the processes of the connected clients, at most as many as there are places.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <poll.h>
#include <sys/types.h>

#include "daemon/base/clock.h"
#include "daemon/base/unique_fd.h"
#include "daemon/net/admission.h"

namespace merlin::rfb {

// Thread-bound.
class ClientTable {
 public:
  // Runs in a client's process: serves the socket, writes bytes of client_process.h into the pipe,
  // and returns the exit status.
  using Serve = std::function<int(int client, int report)>;

  ClientTable(int places, Serve serve);
  ~ClientTable();  // ends all processes
  ClientTable(const ClientTable&) = delete;
  ClientTable& operator=(const ClientTable&) = delete;

  // Gives the client a place and a process; closes the connection if there is no place (see
  // net::decide()). A client that has requested no picture for a minute may lose its place to
  // another one.
  void add(UniqueFd client, Timestamp now);

  // Appends the descriptors to poll, which become readable when a process reports something or
  // ends.
  void appendTo(std::vector<pollfd>& set) const;
  // Reads the reports of the process whose pipe is `fd`; removes its client if the process has
  // ended.
  void read(int fd, Timestamp now);

 private:
  struct Client {
    pid_t pid = -1;
    UniqueFd report;
    net::Occupant occupant;
  };
  void start(UniqueFd client, const net::Peer& peer, Timestamp now);
  void end(std::size_t index, const std::string& reason, Timestamp now);
  void remove(std::size_t index, Timestamp now);
  void logSentAway(const net::Peer& peer, const std::string& why, Timestamp now);

  net::Places places_;
  Serve serve_;
  std::vector<Client> clients_;
  // Number of connections, since the last log line about them, that were refused or ended before
  // their handshake was complete. Each such line names only one of them.
  std::size_t sent_away_ = 0;
  Timestamp logged_{};
};

}  // namespace merlin::rfb
