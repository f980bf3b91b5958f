#include "daemon/status/server.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zmq.hpp>

#include "daemon/base/commands.h"
#include "daemon/base/log.h"

namespace merlin::status {
namespace {

// Time within which followers subscribe again after a restart: they consider a killed role alive
// for 1 s, then look for its successor twice a second.
constexpr Duration kFollowersCome = std::chrono::seconds(3);
constexpr int kServerRound_ms = 100;
constexpr int kMostRequestBytes = 4096;
constexpr int kMostSaidBytes = 4096;  // maximum size of a frame from a subscriber
constexpr int kMostQueued = 100;      // documents queued for a subscriber that does not read
constexpr int kHandshake_ms = 2000;
constexpr std::size_t kEventsKept = 50;
constexpr const char* kZap = "inproc://zeromq.zap.01";
// ZAP domain of the topics. It is empty because a domain cannot be removed from a socket again, and
// with a domain libzmq would authenticate the clients of the publisher's local address too.
constexpr const char* kTopicsDomain = "";
constexpr const char* kCommandsDomain = "commands";
constexpr Duration kSocketCheckPeriod = std::chrono::seconds(1);
constexpr Duration kSayAgain = std::chrono::seconds(10);

// Sets the umask while it exists, so that only the daemon's user can open the sockets that libzmq
// binds.
class Umask {
 public:
  Umask() : before_(::umask(0177)) {}
  ~Umask() { ::umask(before_); }
  Umask(const Umask&) = delete;
  Umask& operator=(const Umask&) = delete;

 private:
  mode_t before_;
};

// Returns the path of the inner socket, which is behind the relay of a public endpoint.
std::string innerOf(const std::string& endpoint) {
  return endpoint.substr(std::string("ipc://").size()) + ".inner";
}

bool isThere(const std::string& path) { return ::access(path.c_str(), F_OK) == 0; }

}  // namespace

struct StatusServer::Sockets {
  zmq::context_t context{1};
  zmq::socket_t publisher{context, zmq::socket_type::pub};
  zmq::socket_t replier{context, zmq::socket_type::rep};
  // Requests from the network. A ROUTER, because a REP of libzmq 4.3.4 loses replies after a
  // malformed request, and the relay cannot see the form of an encrypted one.
  zmq::socket_t network{context, zmq::socket_type::router};
  zmq::socket_t doorman{context, zmq::socket_type::rep};
  struct Bound {
    zmq::socket_t* socket;
    std::string path;
    const CurveServer* encrypted;  // null: not encrypted
    const char* domain;
  };
  std::vector<Bound> bound;
  std::string topics, commands;  // paths of the encrypted sockets; empty: none

  Sockets() = default;
  Sockets(const Sockets&) = delete;
  Sockets& operator=(const Sockets&) = delete;
  ~Sockets() {
    for (const Bound& b : bound) ::unlink(b.path.c_str());
  }
  void bind(zmq::socket_t& socket, const std::string& path, const CurveServer* encrypted = nullptr,
            const char* domain = "") {
    bound.push_back({&socket, path, encrypted, domain});
    bindAt(bound.back());
  }
  // libzmq applies a socket's options to addresses bound afterwards, so that each address of one
  // socket is encrypted or not.
  static void bindAt(const Bound& b) {
    b.socket->set(zmq::sockopt::curve_server, b.encrypted != nullptr);
    if (b.encrypted) {
      if (*b.domain) b.socket->set(zmq::sockopt::zap_domain, b.domain);
      b.socket->set(zmq::sockopt::curve_secretkey, b.encrypted->keys.secret_key);
    }
    b.socket->bind("ipc://" + b.path);
  }
};

namespace {

// Limits the size of a client's messages and the duration of its handshake.
void limit(zmq::socket_t& socket, int most_bytes) {
  socket.set(zmq::sockopt::linger, 0);
  socket.set(zmq::sockopt::maxmsgsize, std::int64_t{most_bytes});
  socket.set(zmq::sockopt::handshake_ivl, kHandshake_ms);
}

// Receives all parts of a message that has arrived; empty if there is no message.
std::vector<zmq::message_t> receiveAll(zmq::socket_t& socket) {
  std::vector<zmq::message_t> parts;
  do {
    parts.emplace_back();
    if (!socket.recv(parts.back(), zmq::recv_flags::dontwait)) return {};
  } while (parts.back().more());
  return parts;
}

template <typename Parts>
void sendAll(zmq::socket_t& socket, const Parts& parts) {
  for (std::size_t i = 0; i < std::size(parts); ++i) {
    socket.send(zmq::buffer(parts[i]),
                i + 1 < std::size(parts) ? zmq::send_flags::sndmore : zmq::send_flags::none);
  }
}

// Returns what the sender of an encrypted message may do; zapAnswer() has set it as the user id.
Grant grantOf(const zmq::message_t& message) {
  const char* const user = ::zmq_msg_gets(message.handle(), "User-Id");
  return user ? grantOfUser(user) : Grant::kNothing;
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
    : settings_(std::move(settings)),
      clock_(clock),
      doors_{{kTopicsDomain, settings_.network.clients},
             {kCommandsDomain, settings_.network_commands.clients}},
      due_(settings_.publications.size()),
      followed_from_(clock.now() + kFollowersCome) {
  settings_.commands.push_back(
      {"events", std::string(findCommand("events")->help), [this]() -> Result<std::string> {
         return fmt::format("[{}]", fmt::join(last_events_, ","));
       }});
}

StatusServer::~StatusServer() {
  relays_.clear();
  thread_.stop();
}

Result<Ok> StatusServer::openSockets() {
  try {
    sockets_ = std::make_unique<Sockets>();
    limit(sockets_->publisher, kMostSaidBytes);
    sockets_->publisher.set(zmq::sockopt::sndhwm, kMostQueued);
    limit(sockets_->replier, kMostRequestBytes);
    limit(sockets_->network, kMostRequestBytes);
    limit(sockets_->doorman, kMostSaidBytes);
    const Umask umask;
    sockets_->doorman.bind(kZap);
    sockets_->bind(sockets_->publisher, innerOf(settings_.status_endpoint));
    sockets_->bind(sockets_->replier, innerOf(settings_.command_endpoint));
    if (!settings_.network.endpoint.empty()) {
      sockets_->topics = innerOf(settings_.status_endpoint + ".network");
      sockets_->bind(sockets_->publisher, sockets_->topics, &settings_.network, kTopicsDomain);
    }
    if (!settings_.network_commands.endpoint.empty()) {
      sockets_->commands = innerOf(settings_.command_endpoint + ".network");
      sockets_->bind(sockets_->network, sockets_->commands, &settings_.network_commands,
                     kCommandsDomain);
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

Result<std::unique_ptr<net::Server>> StatusServer::startNetworkTopics(ThreadWatch& watch) const {
  RelaySettings topics = topicsRelay();
  topics.name = settings_.network_name;
  topics.endpoint = settings_.network.endpoint;
  topics.inner = sockets_->topics;
  topics.limits.opening = std::chrono::seconds(5);  // over a network, with encryption
  topics.zmtp = {1024, 1, 16384};
  auto relay = Relay::start(std::move(topics), watch, clock_);
  if (!relay) return relay.error();
  return std::unique_ptr<net::Server>(*std::move(relay));
}

Result<std::unique_ptr<net::Server>> StatusServer::startNetworkCommands(ThreadWatch& watch) const {
  RelaySettings commands;
  commands.name = fmt::format("commands of the {} over the network", settings_.name);
  commands.endpoint = settings_.network_commands.endpoint;
  commands.inner = sockets_->commands;
  commands.limits.opening = std::chrono::seconds(5);  // over a network, with encryption
  // A handshake costs libzmq half a millisecond, even if the key is unknown.
  commands.limits.accepts_per_s = 50;
  commands.limits.accepts_burst = 50;
  commands.limits.messages_per_s = 100;  // two for each request
  commands.limits.messages_burst = 200;
  commands.zmtp = {kMostRequestBytes, 1, 0};  // CURVE hides how many parts a message has
  auto relay = Relay::start(std::move(commands), watch, clock_);
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
                             {sockets_->doorman.handle(), 0, ZMQ_POLLIN, 0},
                             {sockets_->network.handle(), 0, ZMQ_POLLIN, 0}};
  zmq::poll(items, std::size(items), std::chrono::ceil<std::chrono::milliseconds>(untilDue()));
  if (items[0].revents & ZMQ_POLLIN) answer();
  if (items[1].revents & ZMQ_POLLIN) admit();
  if (items[2].revents & ZMQ_POLLIN) answerNetwork();
  publishDue();
}

// Binds the inner sockets again if their files were removed, as Relay does for the public ones.
void StatusServer::bindAgainWhereGone() {
  const Timestamp now = clock_.now();
  if (now - checked_ < kSocketCheckPeriod) return;
  checked_ = now;
  for (const Sockets::Bound& b : sockets_->bound) {
    const std::string& path = b.path;
    if (isThere(path)) continue;
    std::error_code ignored;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
    const Umask umask;
    // Fails if an earlier bindAt() failed here: nothing is bound then.
    (void)::zmq_unbind(b.socket->handle(), ("ipc://" + path).c_str());
    Sockets::bindAt(b);
    logWarning("status of the {}: the socket {} was removed and has been created again",
               settings_.name, path);
  }
}

Duration StatusServer::untilDue() const {
  const Timestamp now = clock_.now();
  Duration wait = std::chrono::milliseconds(kServerRound_ms / 4);
  for (const Timestamp due : due_) wait = std::min<Duration>(wait, due - now);
  return std::max<Duration>(wait, Duration::zero());
}

void StatusServer::admit() {
  std::vector<std::string> request;
  for (const zmq::message_t& part : receiveAll(sockets_->doorman))
    request.push_back(part.to_string());
  if (!request.empty()) sendAll(sockets_->doorman, zapAnswer(request, doors_));
}

// Answers a request from the network. The ROUTER delivers it in three parts: the connection's name,
// an empty part, the request. A message of another form gets no answer.
void StatusServer::answerNetwork() {
  const auto parts = receiveAll(sockets_->network);
  if (parts.size() != 3 || !parts[1].empty()) return;
  std::string text;
  try {
    text = answerFor(grantOf(parts[2]), parts[2].to_string_view());
  } catch (const std::exception& e) {
    text = failure(e.what());
  }
  const std::string answer[] = {parts[0].to_string(), "", std::move(text)};
  sendAll(sockets_->network, answer);
}

std::string StatusServer::answerFor(Grant grant, std::string_view request) const {
  if (grant == Grant::kCommand) return answerTo(request, settings_.commands);
  const auto refuse = [grant]() -> Result<std::string> {
    return Error{Errc::kInvalidArgument, grant == Grant::kRead
                                             ? "this key may only read: status and events"
                                             : "this key may do nothing"};
  };
  std::vector<Command> allowed = settings_.commands;
  for (Command& command : allowed) {
    const bool reads = command.name == "status" || command.name == "events";
    if (grant == Grant::kRead && reads) continue;
    command.run = refuse;
    command.run_with = nullptr;
  }
  return answerTo(request, allowed);
}

void StatusServer::publishDue() {
  const auto send = [&](const std::string& topic, const std::string& document) {
    sockets_->publisher.send(zmq::buffer(topic), zmq::send_flags::sndmore);
    sockets_->publisher.send(zmq::buffer(document), zmq::send_flags::none);
  };
  const Timestamp now = clock_.now();
  for (const std::string& event : settings_.events()) {
    last_events_.push_back(event);
    unsent_events_.push_back(event);
    for (auto* const events : {&last_events_, &unsent_events_})
      if (events->size() > kEventsKept) events->pop_front();
  }
  if (now >= followed_from_) {
    for (const std::string& event : unsent_events_) send("event", event);
    unsent_events_.clear();
  }
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
