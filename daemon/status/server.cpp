#include "daemon/status/server.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <zmq.hpp>

namespace merlin::status {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRound_ms = 100;
constexpr int kMostRequestBytes = 4096;
constexpr int kMostQueued = 100;  // documents for a subscriber that does not read

// Sockets are for the daemon's user and group.
class Umask {
 public:
  Umask() : before_(::umask(0117)) {}
  ~Umask() { ::umask(before_); }
  Umask(const Umask&) = delete;
  Umask& operator=(const Umask&) = delete;

 private:
  mode_t before_;
};

std::string failure(std::string_view what) {
  return Json{{"ok", false}, {"error", std::string(what)}}.dump(-1, ' ', false,
                                                                Json::error_handler_t::replace);
}

}  // namespace

struct StatusServer::Sockets {
  zmq::context_t context{1};
  zmq::socket_t publisher{context, zmq::socket_type::pub};
  zmq::socket_t replier{context, zmq::socket_type::rep};
  zmq::socket_t doorman{context, zmq::socket_type::rep};
};

namespace {

// After the local sockets: what is set here holds for what is bound from here on.
void bindNetwork(const CurveServer& network, zmq::socket_t& publisher, zmq::socket_t& doorman) {
  doorman.set(zmq::sockopt::linger, 0);
  doorman.bind("inproc://zeromq.zap.01");
  publisher.set(zmq::sockopt::zap_domain, "merlin");
  publisher.set(zmq::sockopt::curve_server, true);
  publisher.set(zmq::sockopt::curve_secretkey, network.keys.secret_key);
  publisher.bind(network.endpoint);
}

Result<std::string> runWith(const Command& command, const nlohmann::json& request) {
  const auto argument = request.find("argument");
  if (argument != request.end() && argument->is_string())
    return command.run_with(argument->get<std::string>());
  return Error{Errc::kInvalidArgument,
               fmt::format("{} wants an \"argument\", a text: {}", command.name, command.help)};
}

std::string z85(const zmq::message_t& key) {
  char text[41] = "";
  if (key.size() != 32) return {};
  ::zmq_z85_encode(text, static_cast<const std::uint8_t*>(key.data()), key.size());
  return text;
}

}  // namespace

Result<std::unique_ptr<StatusServer>> StatusServer::start(StatusServerSettings settings,
                                                          const Clock& clock) {
  const std::string* endpoint = &settings.status_endpoint;
  try {
    auto sockets = std::make_unique<Sockets>();
    sockets->publisher.set(zmq::sockopt::sndhwm, kMostQueued);
    sockets->publisher.set(zmq::sockopt::linger, 0);
    sockets->replier.set(zmq::sockopt::maxmsgsize, std::int64_t{kMostRequestBytes});
    sockets->replier.set(zmq::sockopt::linger, 0);
    const Umask umask;
    sockets->publisher.bind(settings.status_endpoint);
    endpoint = &settings.command_endpoint;
    sockets->replier.bind(settings.command_endpoint);
    if (!settings.network.endpoint.empty()) {
      endpoint = &settings.network.endpoint;
      bindNetwork(settings.network, sockets->publisher, sockets->doorman);
    }
    return std::unique_ptr<StatusServer>(
        new StatusServer(std::move(settings), clock, std::move(sockets)));
  } catch (const zmq::error_t& e) {
    return Error{Errc::kIo, fmt::format("{}: {}", *endpoint, e.what())};
  }
}

StatusServer::StatusServer(StatusServerSettings settings, const Clock& clock,
                           std::unique_ptr<Sockets> sockets)
    : settings_(std::move(settings)),
      clock_(clock),
      sockets_(std::move(sockets)),
      due_(settings_.publications.size()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

StatusServer::~StatusServer() {
  thread_.request_stop();
  thread_.join();
}

void StatusServer::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    try {
      zmq::pollitem_t items[] = {{sockets_->replier.handle(), 0, ZMQ_POLLIN, 0},
                                 {sockets_->doorman.handle(), 0, ZMQ_POLLIN, 0}};
      zmq::poll(items, 2, std::chrono::ceil<std::chrono::milliseconds>(untilDue()));
      if (items[0].revents & ZMQ_POLLIN) answer();
      if (items[1].revents & ZMQ_POLLIN) admit();
      publishDue();
    } catch (const zmq::error_t& e) {
      if (e.num() != EINTR) return;  // the context is gone
    }
    rounds_.fetch_add(1, std::memory_order_relaxed);
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
  const std::string answer[] = {"1.0", id, known ? "200" : "400", known ? "OK" : "no key of ours",
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

void StatusServer::answer() {
  zmq::message_t request;
  if (!sockets_->replier.recv(request, zmq::recv_flags::dontwait)) return;
  const std::string text = reply({static_cast<const char*>(request.data()), request.size()});
  sockets_->replier.send(zmq::buffer(text), zmq::send_flags::none);
}

std::string StatusServer::reply(std::string_view request) {
  // At most 4 KiB come in, so that no depth of nesting can hurt the parser's copies.
  const auto json = nlohmann::json::parse(request, nullptr, false);
  const auto name = json.is_object() ? json.find("command") : json.end();
  std::vector<std::string> names;
  for (const Command& c : settings_.commands) names.push_back(c.name);
  if (!json.is_object() || name == json.end() || !name->is_string()) {
    return failure(R"(a request is {"command": "NAME"}, NAME one of )" +
                   fmt::format("{}", fmt::join(names, ", ")));
  }
  for (const Command& c : settings_.commands) {
    if (*name != c.name) continue;
    const auto result = c.run_with ? runWith(c, json) : c.run();
    return result ? fmt::format(R"({{"ok": true, "result": {}}})", *result)
                  : failure(result.error().what);
  }
  return failure(fmt::format("\"{}\" is no command; commands are {}",
                             name->get<std::string>().substr(0, 64), fmt::join(names, ", ")));
}

}  // namespace merlin::status
