// VrpnSpeaker: a TCP server that sends the same bytes to every client and then nothing more.
#pragma once

#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <poll.h>
#include <sys/socket.h>

#include "daemon/base/unique_fd.h"
#include "daemon/net/connection_server.h"

namespace merlin::test {

class VrpnSpeaker {
 public:
  explicit VrpnSpeaker(std::string bytes)
      : bytes_(std::move(bytes)),
        listener_(*net::listenTcp("127.0.0.1", 0)),
        thread_([this](const std::stop_token& stop) { serve(stop); }) {}

  int port() const { return net::portOf(listener_.get()); }

 private:
  void serve(const std::stop_token& stop) {
    std::vector<UniqueFd> clients;
    while (!stop.stop_requested()) {
      pollfd item{listener_.get(), POLLIN, 0};
      if (::poll(&item, 1, 20) != 1) continue;
      clients.emplace_back(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      (void)::send(clients.back().get(), bytes_.data(), bytes_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    }
  }

  std::string bytes_;
  UniqueFd listener_;
  std::jthread thread_;
};

}  // namespace merlin::test
