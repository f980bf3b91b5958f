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

  // Gives the client a place and a process, or closes the connection if there is none: see
  // net::decide(). A place whose client has taken no picture for a minute can be given to another.
  void add(UniqueFd client, Timestamp now);

  // Descriptors that become readable when a process reports something or ends.
  void appendTo(std::vector<pollfd>& set) const;
  // Reads the reports of one of them.
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
  // Connections that were refused or ended before their handshake was complete: of all since the
  // last line of the log, only one is named.
  std::size_t sent_away_ = 0;
  Timestamp logged_{};
};

}  // namespace merlin::rfb
