#include "daemon/status/server.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zmq.hpp>

#include "daemon/base/log.h"

namespace merlin::status {
namespace {

constexpr int kRound_ms = 100;
constexpr int kMostRequestBytes = 4096;
constexpr int kMostSaidBytes = 4096;  // of one frame from a subscriber
constexpr int kMostQueued = 100;      // documents queued for a subscriber that does not read
constexpr int kHandshake_ms = 2000;
constexpr Duration kCheckPeriod = std::chrono::seconds(1);
constexpr Duration kSayAgain = std::chrono::seconds(10);

// Restricts sockets that libzmq binds to the daemon's user.
class Umask {
 public:
  Umask() : before_(::umask(0177)) {}
  ~Umask() { ::umask(before_); }
  Umask(const Umask&) = delete;
  Umask& operator=(const Umask&) = delete;

 private:
  mode_t before_;
};

// The path of the socket behind a public endpoint.
std::string innerOf(const std::string& endpoint) {
  return endpoint.substr(std::string("ipc://").size()) + ".inner";
}

bool isThere(const std::string& path) { return ::access(path.c_str(), F_OK) == 0; }

}  // namespace

struct StatusServer::Sockets {
  zmq::context_t context{1};
  zmq::socket_t publisher{context, zmq::socket_type::pub};
  zmq::socket_t replier{context, zmq::socket_type::rep};
  zmq::socket_t doorman{context, zmq::socket_type::rep};
  // Sockets and the paths that they are bound to.
  std::vector<std::pair<zmq::socket_t*, std::string>> bound;
  std::string samples;  // path of the encrypted socket; empty: none

  Sockets() = default;
  Sockets(const Sockets&) = delete;
  Sockets& operator=(const Sockets&) = delete;
  ~Sockets() {
    for (const auto& [socket, path] : bound) ::unlink(path.c_str());
  }
  void bind(zmq::socket_t& socket, const std::string& path) {
    socket.bind("ipc://" + path);
    bound.emplace_back(&socket, path);
  }
};

namespace {

// Limits the size of a client's messages and the duration of its handshake.
void limit(zmq::socket_t& socket, int most_bytes) {
  socket.set(zmq::sockopt::linger, 0);
  socket.set(zmq::sockopt::maxmsgsize, std::int64_t{most_bytes});
  socket.set(zmq::sockopt::handshake_ivl, kHandshake_ms);
}

std::string z85(const zmq::message_t& key) {
  char text[41] = "";
  if (key.size() != 32) return {};
  ::zmq_z85_encode(text, static_cast<const std::uint8_t*>(key.data()), key.size());
  return text;
}

}  // namespace

Result<std::unique_ptr<StatusServer>> StatusServer::start(StatusServerSettings settings,
                                                          ThreadWatch& watch, const Clock& clock) {
  std::unique_ptr<StatusServer> server(new StatusServer(std::move(settings), clock));
  if (const auto opened = server->openSockets(); !opened) return opened.error();
  if (const auto started = server->startRelays(watch); !started) return started.error();
  server->thread_ = WatchedThread(
      watch, fmt::format("status of the {}", server->settings_.name),
      [s = server.get()](const std::stop_token& stop, Progress& p) { s->run(stop, p); });
  return server;
}

StatusServer::StatusServer(StatusServerSettings settings, const Clock& clock)
    : settings_(std::move(settings)), clock_(clock), due_(settings_.publications.size()) {}

StatusServer::~StatusServer() {
  relays_.clear();
  thread_.stop();
}

// libzmq applies a socket's options to addresses bound afterwards; the encrypted one comes last, so
// that CURVE holds for it only.
Result<Ok> StatusServer::openSockets() {
  try {
    sockets_ = std::make_unique<Sockets>();
    limit(sockets_->publisher, kMostSaidBytes);
    sockets_->publisher.set(zmq::sockopt::sndhwm, kMostQueued);
    limit(sockets_->replier, kMostRequestBytes);
    const Umask umask;
    sockets_->bind(sockets_->publisher, innerOf(settings_.status_endpoint));
    sockets_->bind(sockets_->replier, innerOf(settings_.command_endpoint));
    if (!settings_.network.endpoint.empty()) {
      limit(sockets_->doorman, kMostSaidBytes);
      sockets_->doorman.bind("inproc://zeromq.zap.01");
      sockets_->publisher.set(zmq::sockopt::zap_domain, "merlin");
      sockets_->publisher.set(zmq::sockopt::curve_server, true);
      sockets_->publisher.set(zmq::sockopt::curve_secretkey, settings_.network.keys.secret_key);
      sockets_->samples = innerOf(settings_.status_endpoint + ".samples");
      sockets_->bind(sockets_->publisher, sockets_->samples);
    }
    return Ok{};
  } catch (const zmq::error_t& e) {
    return Error{Errc::kIo,
                 fmt::format("the sockets of {}: {}", settings_.status_endpoint, e.what())};
  }
}

// The limits are low because a subscriber only sends subscriptions and heartbeats.
RelaySettings StatusServer::topicsRelay() const {
  RelaySettings relay;
  relay.name = fmt::format("topics of the {}", settings_.name);
  relay.endpoint = settings_.status_endpoint;
  relay.inner = innerOf(settings_.status_endpoint);
  relay.limits.output_bytes = 1 << 20;
  relay.limits.messages_per_s = 20;
  relay.limits.messages_burst = 100;
  relay.zmtp = {1024, 1, 4096};
  return relay;
}

Result<Ok> StatusServer::startRelays(ThreadWatch& watch) {
  RelaySettings commands;
  commands.name = fmt::format("commands of the {}", settings_.name);
  commands.endpoint = settings_.command_endpoint;
  commands.inner = innerOf(settings_.command_endpoint);
  commands.zmtp = {kMostRequestBytes, 2, 0, true};
  for (const RelaySettings& settings : {commands, topicsRelay()}) {
    auto relay = Relay::start(settings, watch, clock_);
    if (!relay) return relay.error();
    relays_.push_back(*std::move(relay));
  }
  return Ok{};
}

Result<std::unique_ptr<net::Server>> StatusServer::startSamples(ThreadWatch& watch) const {
  RelaySettings samples = topicsRelay();
  samples.name = "samples for other machines";
  samples.endpoint = settings_.network.endpoint;
  samples.inner = sockets_->samples;
  samples.limits.opening = std::chrono::seconds(5);  // over a network, with encryption
  samples.zmtp = {1024, 1, 16384};
  auto relay = Relay::start(std::move(samples), watch, clock_);
  if (!relay) return relay.error();
  return std::unique_ptr<net::Server>(*std::move(relay));
}

std::vector<net::ServerReport> StatusServer::reports() const {
  std::vector<net::ServerReport> reports;
  for (const auto& relay : relays_) reports.push_back(relay->report());
  return reports;
}

void StatusServer::run(const std::stop_token& stop, Progress& progress) {
  while (!stop.stop_requested()) {
    try {
      round();
      bindAgainWhereGone();
    } catch (const std::exception& e) {
      const Timestamp now = clock_.now();
      if (now - said_ >= kSayAgain) {
        said_ = now;
        logError("status of the {}: {}; it continues", settings_.name, e.what());
      }
    }
    progress.step();
  }
}

void StatusServer::round() {
  zmq::pollitem_t items[] = {{sockets_->replier.handle(), 0, ZMQ_POLLIN, 0},
                             {sockets_->doorman.handle(), 0, ZMQ_POLLIN, 0}};
  zmq::poll(items, 2, std::chrono::ceil<std::chrono::milliseconds>(untilDue()));
  if (items[0].revents & ZMQ_POLLIN) answer();
  if (items[1].revents & ZMQ_POLLIN) admit();
  publishDue();
}

// Binds the inner sockets again if their files were removed, as Relay does for the public ones.
void StatusServer::bindAgainWhereGone() {
  const Timestamp now = clock_.now();
  if (now - checked_ < kCheckPeriod) return;
  checked_ = now;
  for (auto& [socket, path] : sockets_->bound) {
    if (isThere(path)) continue;
    std::error_code ignored;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
    const Umask umask;
    socket->unbind("ipc://" + path);
    socket->bind("ipc://" + path);
    logWarning("status of the {}: the socket {} was removed and has been created again",
               settings_.name, path);
  }
}

Duration StatusServer::untilDue() const {
  const Timestamp now = clock_.now();
  Duration wait = std::chrono::milliseconds(kRound_ms / 4);
  for (const Timestamp due : due_) wait = std::min<Duration>(wait, due - now);
  return std::max<Duration>(wait, Duration::zero());
}

// RFC 27, ZAP: version, request id, domain, address, identity, mechanism, then the client's key.
void StatusServer::admit() {
  std::vector<zmq::message_t> request;
  do {
    request.emplace_back();
    if (!sockets_->doorman.recv(request.back(), zmq::recv_flags::dontwait)) return;
  } while (request.back().more());
  const bool known = request.size() == 7 && request[5].to_string_view() == "CURVE" &&
                     std::count(settings_.network.clients.begin(), settings_.network.clients.end(),
                                z85(request[6])) > 0;
  const std::string id = request.size() > 1 ? request[1].to_string() : "";
  const std::string answer[] = {"1.0", id, known ? "200" : "400", known ? "OK" : "unknown key",
                                "",    ""};
  for (std::size_t i = 0; i < std::size(answer); ++i)
    sockets_->doorman.send(zmq::buffer(answer[i]), i + 1 < std::size(answer)
                                                       ? zmq::send_flags::sndmore
                                                       : zmq::send_flags::none);
}

void StatusServer::publishDue() {
  const auto send = [&](const std::string& topic, const std::string& document) {
    sockets_->publisher.send(zmq::buffer(topic), zmq::send_flags::sndmore);
    sockets_->publisher.send(zmq::buffer(document), zmq::send_flags::none);
  };
  const Timestamp now = clock_.now();
  for (const std::string& event : settings_.events()) send("event", event);
  for (std::size_t i = 0; i < due_.size(); ++i) {
    if (now < due_[i]) continue;
    due_[i] = now + settings_.publications[i].interval;
    send(settings_.publications[i].topic, settings_.publications[i].document());
  }
}

// Receives all parts of a request, because the socket can answer only then.
void StatusServer::answer() {
  zmq::message_t request;
  if (!sockets_->replier.recv(request, zmq::recv_flags::dontwait)) return;
  bool parts = false;
  for (bool more = request.more(); more; parts = true) {
    zmq::message_t part;
    if (!sockets_->replier.recv(part, zmq::recv_flags::dontwait)) break;
    more = part.more();
  }
  std::string text;
  try {
    text = parts ? failure("a request must have one part; this one had several")
                 : answerTo(request.to_string_view(), settings_.commands);
  } catch (const std::exception& e) {  // without an answer the socket would take no more requests
    text = failure(e.what());
  }
  sockets_->replier.send(zmq::buffer(text), zmq::send_flags::none);
}

}  // namespace merlin::status
