#include "daemon/page/http_server.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <utility>

#include <fmt/format.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "daemon/base/words.h"
#include "daemon/page/gate.h"

namespace merlin::page {
namespace {

constexpr std::size_t kMemory = 16 << 10;  // bytes for a connection's request, without its content
// Number of connections that the library allows beyond our limit, because it still counts a
// connection that was closed here until it notices.
constexpr unsigned kClosing = 64;
constexpr std::size_t kMostAccepted = 32;  // maximum number of connections accepted in a round
constexpr Duration kNoDescriptors = std::chrono::seconds(1);

// Headers that every answer has.
constexpr std::pair<const char*, const char*> kSecurityHeaders[] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
     "connect-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; "
     "frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
};

using BodyOwner = std::shared_ptr<const std::string>;

// The content is not copied: the response holds a reference.
MHD_Response* makeResponse(const Answer& answer) {
  static const BodyOwner kEmpty = std::make_shared<const std::string>();
  auto* const owner = new BodyOwner(answer.body ? answer.body : kEmpty);
  MHD_Response* const response = MHD_create_response_from_buffer_with_free_callback_cls(
      (*owner)->size(), const_cast<char*>((*owner)->data()),  // NOLINT: the library only reads
      [](void* held) { delete static_cast<BodyOwner*>(held); }, owner);
  if (!response) {
    delete owner;
    return nullptr;
  }
  for (const auto& [name, value] : kSecurityHeaders) MHD_add_response_header(response, name, value);
  if (!answer.type.empty())
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, answer.type.c_str());
  bool cached = false;
  for (const auto& [name, value] : answer.headers) {
    MHD_add_response_header(response, name.c_str(), value.c_str());
    cached = cached || name == MHD_HTTP_HEADER_CACHE_CONTROL;
  }
  if (!cached) MHD_add_response_header(response, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
  return response;
}

MHD_Result queue(MHD_Connection* connection, const Answer& answer) {
  MHD_Response* const response = makeResponse(answer);
  if (!response) return MHD_NO;
  const MHD_Result queued = MHD_queue_response(connection, answer.status, response);
  MHD_destroy_response(response);  // the library holds its own reference
  return queued;
}

void keepHeader(Request& request, std::string name, std::string_view value) {
  name = lowerCase(name);
  const auto is = [&](const char* known) { return name == known; };
  request.passed_on = request.passed_on || std::ranges::any_of(kProxyHeaders, is);
  if (std::ranges::none_of(kKeptHeaders, is)) return;
  request.repeated = !request.headers.emplace(std::move(name), value).second || request.repeated;
}

}  // namespace

struct HttpServer::Client {
  net::Occupant occupant;
  Timestamp until{};     // when it is closed unless it completes a request
  bool busy = false;     // a request is being answered
  bool closing = false;  // was closed here; the library will notice
  TokenBucket own;       // requests that the client may send in any case
};

struct HttpServer::Exchange {
  HttpServer& server;
  MHD_Connection* connection;
  Request request;
  std::uint64_t id;
  bool too_large = false, handled = false;
};

// Callbacks of the library, which is written in C: no exception may leave them.
struct HttpServer::Library {
  static int descriptorOf(MHD_Connection* connection) {
    const MHD_ConnectionInfo* const info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    return info ? info->connect_fd : -1;
  }

  static Client* clientOf(HttpServer& server, MHD_Connection* connection) {
    const auto found = server.clients_.find(descriptorOf(connection));
    return found == server.clients_.end() ? nullptr : &found->second;
  }

  static MHD_Result keepQuery(void* to, MHD_ValueKind /*kind*/, const char* key,
                              const char* value) noexcept {
    try {
      Request& request = *static_cast<Request*>(to);
      if (request.query.size() < kMostQueries)
        request.query.emplace(key ? key : "", value ? value : "");
      return MHD_YES;
    } catch (const std::exception&) {
      return MHD_NO;
    }
  }

  static MHD_Result keep(void* to, MHD_ValueKind /*kind*/, const char* key,
                         const char* value) noexcept {
    try {
      keepHeader(*static_cast<Request*>(to), key ? key : "", value ? value : "");
      return MHD_YES;
    } catch (const std::exception&) {
      return MHD_NO;
    }
  }

  // The library calls this when the headers are complete, for each part of the content, and when
  // all of it has arrived.
  static MHD_Result access(void* owner, MHD_Connection* connection, const char* url,
                           const char* method, const char* /*version*/, const char* data,
                           size_t* size, void** context) noexcept {
    try {
      auto& server = *static_cast<HttpServer*>(owner);
      if (!*context) return begin(server, connection, {url, method}, context);
      auto& exchange = *static_cast<Exchange*>(*context);
      if (*size > 0) {
        exchange.too_large |= exchange.request.body.size() + *size > kMostBodyBytes;
        if (!exchange.too_large) exchange.request.body.append(data, *size);
        *size = 0;
        return MHD_YES;
      }
      if (exchange.handled) return MHD_YES;
      exchange.handled = true;
      if (const auto answer = server.respond(exchange)) return queue(connection, *answer);
      server.waiting_[exchange.id] = connection;
      MHD_suspend_connection(connection);
      return MHD_YES;
    } catch (const std::exception&) {
      return MHD_NO;  // closes the connection
    }
  }

  struct Line {
    const char *url, *method;
  };
  static MHD_Result begin(HttpServer& server, MHD_Connection* connection, const Line& line,
                          void** context) {
    Client* const client = clientOf(server, connection);
    if (!client) return MHD_NO;
    auto exchange = std::make_unique<Exchange>(
        Exchange{server, connection, {}, server.next_id_++, false, false});
    exchange->request.method = line.method;
    exchange->request.path = line.url;
    MHD_get_connection_values(connection, MHD_HEADER_KIND, &keep, &exchange->request);
    MHD_get_connection_values(connection, MHD_GET_ARGUMENT_KIND, &keepQuery, &exchange->request);
    client->busy = true;
    client->occupant.established = true;
    client->occupant.active = server.clock_.now();
    *context = exchange.release();
    return MHD_YES;
  }

  static void completed(void* owner, MHD_Connection* connection, void** context,
                        MHD_RequestTerminationCode /*how*/) noexcept {
    auto& server = *static_cast<HttpServer*>(owner);
    const std::unique_ptr<Exchange> exchange(static_cast<Exchange*>(*context));
    *context = nullptr;
    if (exchange) server.waiting_.erase(exchange->id);
    if (Client* const client = clientOf(server, connection)) {
      const Timestamp now = server.clock_.now();
      client->busy = false;
      client->occupant.active = now;
      client->until = now + server.limits_.patience;
    }
  }

  static void connected(void* owner, MHD_Connection* connection, void** /*context*/,
                        MHD_ConnectionNotificationCode what) noexcept {
    if (what != MHD_CONNECTION_NOTIFY_CLOSED) return;
    auto& server = *static_cast<HttpServer*>(owner);
    server.clients_.erase(descriptorOf(connection));
    const std::lock_guard lock(server.mutex_);
    server.report_.connections = server.clients_.size();
  }
};

Result<std::unique_ptr<HttpServer>> HttpServer::make(UniqueFd listener, const HttpLimits& limits,
                                                     Handle handle, const Clock& clock) {
  std::unique_ptr<HttpServer> server(
      new HttpServer(std::move(listener), limits, std::move(handle), clock));
  if (const auto started = server->start(); !started) return started.error();
  return server;
}

HttpServer::HttpServer(UniqueFd listener, const HttpLimits& limits, Handle handle,
                       const Clock& clock)
    : listener_(std::move(listener)),
      limits_(limits),
      handle_(std::move(handle)),
      clock_(clock),
      accepts_(limits.accepts_per_s, limits.accepts_burst),
      request_tokens_(limits.requests_per_s, limits.requests_burst) {
  report_.name = "page";
}

Result<Ok> HttpServer::start() {
  library_ = MHD_start_daemon(
      MHD_USE_EPOLL | MHD_USE_NO_LISTEN_SOCKET | MHD_ALLOW_SUSPEND_RESUME, 0, nullptr, nullptr,
      &Library::access, this, MHD_OPTION_NOTIFY_COMPLETED, &Library::completed, this,
      MHD_OPTION_NOTIFY_CONNECTION, &Library::connected, this, MHD_OPTION_CONNECTION_LIMIT,
      static_cast<unsigned>(limits_.places.all) + kClosing, MHD_OPTION_CONNECTION_MEMORY_LIMIT,
      kMemory, MHD_OPTION_STRICT_FOR_CLIENT, 1, MHD_OPTION_END);
  const MHD_DaemonInfo* const info =
      library_ ? MHD_get_daemon_info(library_, MHD_DAEMON_INFO_EPOLL_FD) : nullptr;
  if (!info)
    return Error{Errc::kIo, fmt::format("libmicrohttpd does not start: {}", std::strerror(errno))};
  epoll_ = info->epoll_fd;
  return Ok{};
}

HttpServer::~HttpServer() {
  if (!library_) return;
  // The library may not be stopped while connections are suspended.
  while (!waiting_.empty())
    answer(waiting_.begin()->first, errorAnswer(503, "the page is being stopped"));
  MHD_run(library_);
  MHD_stop_daemon(library_);
}

net::ServerReport HttpServer::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

void HttpServer::count(std::uint64_t net::ServerReport::*counter, const std::string& last) {
  const std::lock_guard lock(mutex_);
  ++(report_.*counter);
  report_.connections = clients_.size();
  if (!last.empty()) report_.last = last;
}

Duration HttpServer::waitTime(Duration at_most) const {
  unsigned long long ms = 0;  // NOLINT(google-runtime-int): the library's type
  if (MHD_get_timeout(library_, &ms) == MHD_YES)
    at_most = std::min<Duration>(at_most, std::chrono::milliseconds(ms));
  return std::max(at_most, Duration::zero());
}

void HttpServer::round(Duration at_most, std::span<const int> wakers) {
  const bool accepts = clock_.now() >= accept_from_;
  std::vector<pollfd> set = {{epoll_, POLLIN, 0}, {accepts ? listener_.get() : -1, POLLIN, 0}};
  for (const int fd : wakers) set.push_back({fd, POLLIN, 0});
  ::poll(set.data(), set.size(),
         static_cast<int>(waitTime(at_most) / std::chrono::milliseconds(1)));
  if (set[1].revents != 0) accept();
  closeSilent(clock_.now());
  MHD_run(library_);
}

void HttpServer::accept() {
  const Timestamp now = clock_.now();
  for (std::size_t i = 0; i < kMostAccepted; ++i) {
    if (!accepts_.take(1, now)) {
      accept_from_ = now + accepts_.waitFor(1, now);
      return;
    }
    sockaddr_in address{};
    socklen_t size = sizeof address;
    const int fd = ::accept4(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size,
                             SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd < 0) {
      if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM)
        accept_from_ = now + kNoDescriptors;
      return;
    }
    const net::Peer peer = net::peerOf(fd);
    if (!admit(peer, now)) {
      ::close(fd);
      continue;
    }
    clients_.insert_or_assign(fd, Client{{peer, now, now, false},
                                         now + limits_.patience,
                                         false,
                                         false,
                                         {limits_.own_per_s, limits_.own_burst}});
    count(&net::ServerReport::accepted, "");
    // From here on the library owns the descriptor, also if this fails.
    if (MHD_add_connection(library_, fd, reinterpret_cast<const sockaddr*>(&address), size) !=
        MHD_YES)
      clients_.erase(fd);
  }
}

// Returns whether a new connection gets a place; closes another connection for it if necessary.
bool HttpServer::admit(const net::Peer& peer, Timestamp now) {
  std::vector<net::Occupant> occupants;
  std::vector<int> descriptors;
  for (const auto& [fd, client] : clients_) {
    if (client.closing) continue;
    occupants.push_back(client.occupant);
    descriptors.push_back(fd);
  }
  const net::Decision decision = net::decide(occupants, peer, limits_.places, now);
  const bool crowded = clients_.size() >= limits_.places.all + kClosing / 2;
  if (decision.kind == net::Decision::Kind::kRefuse || crowded) {
    count(&net::ServerReport::refused,
          fmt::format("refused {}: {} of {} places are taken", net::peerName(peer),
                      occupants.size(), limits_.places.all));
    return false;
  }
  if (decision.kind == net::Decision::Kind::kReplace) {
    const int victim = descriptors[decision.victim];
    clients_.at(victim).closing = true;
    ::shutdown(victim, SHUT_RDWR);
    count(&net::ServerReport::replaced,
          fmt::format("closed {} for a newcomer", net::peerName(occupants[decision.victim].peer)));
  }
  return true;
}

// Closes connections that have not completed a request in time.
void HttpServer::closeSilent(Timestamp now) {
  for (auto& [fd, client] : clients_) {
    if (client.closing || now < client.until) continue;
    client.closing = true;
    ::shutdown(fd, SHUT_RDWR);
    if (client.occupant.established && !client.busy) continue;  // a browser without a request
    count(client.busy ? &net::ServerReport::slow : &net::ServerReport::silent,
          fmt::format("closed {}: {} within {:.0f} s", net::peerName(client.occupant.peer),
                      client.busy ? "it did not take its answer" : "it completed no request",
                      toSeconds(limits_.patience)));
  }
}

// Whether the client may send this request. Beyond its own allowance it uses the allowance that all
// clients share.
bool HttpServer::mayAsk(MHD_Connection* connection) {
  const Timestamp now = clock_.now();
  Client* const client = Library::clientOf(*this, connection);
  return (client && client->own.take(1, now)) || request_tokens_.take(1, now);
}

std::optional<Answer> HttpServer::respond(Exchange& exchange) {
  ++requests_;
  if (!mayAsk(exchange.connection))
    return errorAnswer(429, "there are too many requests; try again later");
  if (exchange.too_large)
    return errorAnswer(
        413, fmt::format("the content of the request has more than {} bytes", kMostBodyBytes));
  return handle_(exchange.request, exchange.id);
}

void HttpServer::answer(std::uint64_t id, const Answer& answer) {
  const auto found = waiting_.find(id);
  if (found == waiting_.end()) return;
  MHD_Connection* const connection = found->second;
  waiting_.erase(found);
  queue(connection, answer);
  MHD_resume_connection(connection);
}

}  // namespace merlin::page
