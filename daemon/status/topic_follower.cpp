#include "daemon/status/topic_follower.h"

#include <utility>

#include <fmt/format.h>
#include <zmq.hpp>

namespace merlin::status {
namespace {

constexpr int kMostKept = 100;
constexpr std::int64_t kMostBytes = 1 << 20;

}  // namespace

struct TopicFollower::Connection {
  zmq::context_t context{1};
  std::optional<zmq::socket_t> socket;
  std::string endpoint;
};

TopicFollower::TopicFollower(std::vector<std::string> topics)
    : topics_(std::move(topics)), connection_(std::make_unique<Connection>()) {}
TopicFollower::~TopicFollower() = default;

Result<Ok> TopicFollower::connect(const std::string& status_endpoint) {
  Connection& c = *connection_;
  if (c.endpoint == status_endpoint) return Ok{};
  c.socket.reset();
  c.endpoint.clear();
  if (status_endpoint.empty()) return Ok{};
  try {
    c.socket.emplace(c.context, zmq::socket_type::sub);
    c.socket->set(zmq::sockopt::linger, 0);
    c.socket->set(zmq::sockopt::rcvhwm, kMostKept);
    c.socket->set(zmq::sockopt::maxmsgsize, kMostBytes);
    for (const std::string& topic : topics_) c.socket->set(zmq::sockopt::subscribe, topic);
    c.socket->connect(status_endpoint);
    c.endpoint = status_endpoint;
    return Ok{};
  } catch (const std::exception& e) {
    c.socket.reset();
    return Error{Errc::kIo, fmt::format("{}: {}", status_endpoint, e.what())};
  }
}

std::optional<TopicFollower::Message> TopicFollower::take() {
  Connection& c = *connection_;
  if (!c.socket) return std::nullopt;
  try {
    zmq::message_t topic, document;
    while (c.socket->recv(topic, zmq::recv_flags::dontwait)) {
      // The parts of a message arrive together.
      int parts = 1;
      for (bool more = topic.more(); more; more = document.more(), ++parts) {
        if (!c.socket->recv(document, zmq::recv_flags::dontwait)) break;
      }
      if (parts == 2) return Message{topic.to_string(), document.to_string()};
    }
  } catch (const std::exception&) {  // the next connect() creates a new socket
    c.socket.reset();
    c.endpoint.clear();
  }
  return std::nullopt;
}

}  // namespace merlin::status
