// HttpServer: the adapter of libmicrohttpd. No other file uses the library.
//
// One thread serves all clients, and none of them can hold up another one: connections get places
// by daemon/net/admission.h, and one that has not completed a request within HttpLimits::patience
// is closed, whether it sends nothing, sends slowly, or does not read. A request may have at most
// kMostBodyBytes of content and 16 KiB of everything else.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/token_bucket.h"
#include "daemon/base/unique_fd.h"
#include "daemon/net/connection_server.h"
#include "daemon/page/exchange.h"

struct MHD_Connection;
struct MHD_Daemon;

namespace merlin::page {

struct HttpLimits {
  net::Places places{.all = 64, .per_peer = 48};
  Duration patience = std::chrono::seconds(15);  // from the end of a request to that of the next
  double accepts_per_s = 200, accepts_burst = 100;
  // own_...: requests that each connection may send whatever the others do; requests_...: further
  // requests of all connections together. Requests beyond both are answered with 429.
  double own_per_s = 20, own_burst = 10;
  double requests_per_s = 300, requests_burst = 300;
};

// Thread-bound except for report().
class HttpServer {
 public:
  // Handles a request: returns the answer, or nothing if answer() will be called with this `id`
  // later. Must not throw.
  using Handle = std::function<std::optional<Answer>(const Request& request, std::uint64_t id)>;

  // `listener`: a listening, non-blocking socket. `clock` must outlive this. Errors: kIo (no
  // memory, no descriptor).
  static Result<std::unique_ptr<HttpServer>> make(UniqueFd listener, const HttpLimits& limits,
                                                  Handle handle, const Clock& clock);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  // Waits at most `at_most`, or until a client is ready or one of `wakers` (descriptors) is
  // readable; then serves every client that is ready.
  void round(Duration at_most, std::span<const int> wakers);

  // Answers a request for which Handle returned nothing; does nothing if its client is gone.
  void answer(std::uint64_t id, const Answer& answer);

  net::ServerReport report() const;  // thread-safe
  std::uint64_t requests() const noexcept { return requests_; }

 private:
  struct Client;
  struct Exchange;
  struct Library;  // the callbacks

  HttpServer(UniqueFd listener, const HttpLimits& limits, Handle handle, const Clock& clock);
  Result<Ok> start();
  Duration waitTime(Duration at_most) const;
  void accept();
  bool admit(const net::Peer& peer, Timestamp now);
  void closeSilent(Timestamp now);
  void count(std::uint64_t net::ServerReport::*counter, const std::string& last);
  bool mayAsk(MHD_Connection* connection);
  std::optional<Answer> respond(Exchange& exchange);

  UniqueFd listener_;
  HttpLimits limits_;
  Handle handle_;
  const Clock& clock_;
  MHD_Daemon* library_ = nullptr;
  int epoll_ = -1;                                    // the library's epoll descriptor
  std::map<int, Client> clients_;                     // by descriptor
  std::map<std::uint64_t, MHD_Connection*> waiting_;  // requests that wait for answer(), by id
  std::uint64_t requests_ = 0, next_id_ = 1;
  TokenBucket accepts_, request_tokens_;
  Timestamp accept_from_{};
  mutable std::mutex mutex_;
  net::ServerReport report_;  // guarded by mutex_
};

}  // namespace merlin::page
