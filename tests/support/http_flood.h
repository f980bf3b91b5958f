// HttpFlood: clients that send requests to the page's server without a pause, each with its own
// thread and connection.
#pragma once

#include <atomic>
#include <cstdint>
#include <stop_token>
#include <thread>
#include <vector>

#include "tests/support/http_client.h"

namespace merlin::test {

class HttpFlood {
 public:
  HttpFlood(int port, int clients) : port_(port) {
    for (int i = 0; i < clients; ++i)
      threads_.emplace_back([this](const std::stop_token& stop) { loop(stop); });
  }

  // Number of answers with the status 429, "too many requests".
  std::uint64_t refused() const noexcept { return refused_; }

  // Stops the clients and waits for them. Each ends once the server has answered it or closed its
  // connection.
  void stop() { threads_.clear(); }

 private:
  void loop(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      KeptConnection connection(port_);
      for (int status = 1; status != 0 && !stop.stop_requested();) {
        status = connection.get("/page.css");
        if (status == 429) ++refused_;
      }
    }
  }

  int port_;
  std::atomic<std::uint64_t> refused_{0};
  std::vector<std::jthread> threads_;
};

}  // namespace merlin::test
