#include "daemon/status/client.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <zmq.hpp>

namespace merlin::status {
namespace {

int milliseconds(Duration d) { return static_cast<int>(d / std::chrono::milliseconds(1)); }

constexpr Duration kAttempt = std::chrono::seconds(1);

Result<std::string> askOnce(const std::string& command_endpoint, const std::string& command,
                            Duration timeout, const std::string& argument) {
  try {
    zmq::context_t context{1};
    zmq::socket_t socket{context, zmq::socket_type::req};
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::rcvtimeo, milliseconds(timeout));
    socket.set(zmq::sockopt::sndtimeo, milliseconds(timeout));
    socket.connect(command_endpoint);
    nlohmann::json wanted = {{"command", command}};
    if (!argument.empty()) wanted["argument"] = argument;
    const std::string request = wanted.dump();
    zmq::message_t answer;
    if (!socket.send(zmq::buffer(request)) || !socket.recv(answer)) {
      return Error{Errc::kTimeout, "no answer"};
    }
    const auto json = nlohmann::json::parse(answer.to_string_view(), nullptr, false);
    if (json.is_object() && json.value("ok", false) && json.contains("result"))
      return json["result"].dump();
    const std::string why =
        json.is_object() ? json.value("error", "no reason") : "the answer is not JSON";
    return Error{Errc::kInvalidArgument, fmt::format("{}: {}", command_endpoint, why)};
  } catch (const std::exception& e) {
    return Error{Errc::kIo, fmt::format("{}: {}", command_endpoint, e.what())};
  }
}

}  // namespace

Result<std::string> ask(const std::string& command_endpoint, const std::string& command,
                        Duration timeout, const std::string& argument) {
  const bool again = command == "status" && argument.empty();
  const int attempts = again ? std::max(1, static_cast<int>(timeout / kAttempt)) : 1;
  for (int attempt = 1;; ++attempt) {
    auto answer = askOnce(command_endpoint, command, timeout / attempts, argument);
    if (answer || answer.error().code != Errc::kTimeout) return answer;
    if (attempt < attempts) continue;
    return Error{Errc::kTimeout, fmt::format("{}: no answer within {:.1f} s", command_endpoint,
                                             toSeconds(timeout))};
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
