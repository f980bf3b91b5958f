#include "daemon/status/client.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <zmq.hpp>

namespace merlin::status {
namespace {

int milliseconds(Duration d) { return static_cast<int>(d / std::chrono::milliseconds(1)); }

constexpr Duration kAttempt = std::chrono::seconds(1);

std::string requestText(const std::string& command, const std::string& argument) {
  nlohmann::json wanted = {{"command", command}};
  if (!argument.empty()) wanted["argument"] = argument;
  return wanted.dump();
}

Result<std::string> resultOf(const std::string& command_endpoint, std::string_view answer) {
  const auto json = nlohmann::json::parse(answer, nullptr, false);
  if (json.is_object() && json.value("ok", false) && json.contains("result"))
    return json["result"].dump();
  const std::string why =
      json.is_object() ? json.value("error", "no reason") : "the answer is not JSON";
  return Error{Errc::kInvalidArgument, fmt::format("{}: {}", command_endpoint, why)};
}

void connect(zmq::socket_t& socket, const CommandAddress& server) {
  socket.set(zmq::sockopt::linger, 0);
  if (server.keys) {
    socket.set(zmq::sockopt::curve_serverkey, server.keys->server_key);
    socket.set(zmq::sockopt::curve_publickey, server.keys->own.public_key);
    socket.set(zmq::sockopt::curve_secretkey, server.keys->own.secret_key);
  }
  socket.connect(server.endpoint);
}

Result<std::string> askOnce(const CommandAddress& server, const std::string& command,
                            Duration timeout, const std::string& argument) {
  try {
    zmq::context_t context{1};
    zmq::socket_t socket{context, zmq::socket_type::req};
    socket.set(zmq::sockopt::rcvtimeo, milliseconds(timeout));
    socket.set(zmq::sockopt::sndtimeo, milliseconds(timeout));
    connect(socket, server);
    const std::string request = requestText(command, argument);
    zmq::message_t answer;
    if (!socket.send(zmq::buffer(request)) || !socket.recv(answer)) {
      return Error{Errc::kTimeout, "no answer"};
    }
    return resultOf(server.endpoint, answer.to_string_view());
  } catch (const std::exception& e) {
    return Error{Errc::kIo, fmt::format("{}: {}", server.endpoint, e.what())};
  }
}

// Returns the message for a server that does not answer; for one on another machine it lists
// possible causes.
std::string noAnswer(const CommandAddress& server, Duration timeout) {
  return fmt::format("{}: no answer within {:.1f} s{}", server.endpoint, toSeconds(timeout),
                     server.keys ? "; does it run there, with this server key, and does it list "
                                   "our public key?"
                                 : "");
}

}  // namespace

bool CommandAddress::operator==(const CommandAddress& other) const {
  const auto all = [](const CommandAddress& a) {
    return a.keys ? a.keys->server_key + a.keys->own.secret_key : std::string();
  };
  return endpoint == other.endpoint && all(*this) == all(other);
}

Result<std::string> ask(const CommandAddress& server, const std::string& command, Duration timeout,
                        const std::string& argument) {
  const bool again = command == "status" && argument.empty();
  const int attempts = again ? std::max(1, static_cast<int>(timeout / kAttempt)) : 1;
  for (int attempt = 1;; ++attempt) {
    auto answer = askOnce(server, command, timeout / attempts, argument);
    if (answer || answer.error().code != Errc::kTimeout) return answer;
    if (attempt < attempts) continue;
    return Error{Errc::kTimeout, noAnswer(server, timeout)};
  }
}

struct CommandSender::Connection {
  zmq::context_t context{1};
  std::optional<zmq::socket_t> socket;
  CommandAddress server{""};      // the server to which the socket is connected
  std::optional<Timestamp> sent;  // set while an answer is outstanding
};

CommandSender::CommandSender() : connection_(std::make_unique<Connection>()) {}
CommandSender::~CommandSender() = default;

bool CommandSender::isReady() const noexcept { return !connection_->sent; }

Result<Ok> CommandSender::send(const CommandAddress& server, const std::string& command,
                               const std::string& argument, Timestamp now) {
  Connection& c = *connection_;
  try {
    if (!c.socket || !(c.server == server)) {
      c.socket.emplace(c.context, zmq::socket_type::req);
      connect(*c.socket, server);
      c.server = server;
    }
    if (c.socket->send(zmq::buffer(requestText(command, argument)), zmq::send_flags::dontwait))
      c.sent = now;
    return Ok{};
  } catch (const std::exception& e) {
    c.socket.reset();
    return Error{Errc::kIo, fmt::format("{}: {}", server.endpoint, e.what())};
  }
}

std::optional<Result<std::string>> CommandSender::answer(Timestamp now) {
  Connection& c = *connection_;
  if (!c.sent) return std::nullopt;
  try {
    zmq::message_t answer;
    if (c.socket->recv(answer, zmq::recv_flags::dontwait)) {
      c.sent.reset();
      return resultOf(c.server.endpoint, answer.to_string_view());
    }
    if (now - *c.sent < kPatience) return std::nullopt;
    // The protocol allows no further request without an answer: begin with a new socket.
    c.sent.reset();
    c.socket.reset();
    return Error{Errc::kTimeout, noAnswer(c.server, kPatience)};
  } catch (const std::exception& e) {
    c.sent.reset();
    c.socket.reset();
    return Error{Errc::kIo, fmt::format("{}: {}", c.server.endpoint, e.what())};
  }
}

Result<Ok> follow(const std::vector<std::string>& status_endpoints,
                  const std::vector<std::string>& topics, Duration patience,
                  const std::function<bool(const std::string&, const std::string&)>& take) {
  try {
    zmq::context_t context{1};
    zmq::socket_t socket{context, zmq::socket_type::sub};
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::rcvtimeo, milliseconds(patience));
    for (const std::string& topic : topics) socket.set(zmq::sockopt::subscribe, topic);
    for (const std::string& endpoint : status_endpoints) socket.connect(endpoint);
    for (;;) {
      zmq::message_t topic, document;
      if (!socket.recv(topic))
        return Error{Errc::kTimeout, fmt::format("nothing for {:.1f} s", toSeconds(patience))};
      if (!topic.more() || !socket.recv(document)) continue;
      if (!take(topic.to_string(), document.to_string())) return Ok{};
    }
  } catch (const zmq::error_t& e) {
    return Error{Errc::kIo, fmt::format("status socket: {}", e.what())};
  }
}

}  // namespace merlin::status
