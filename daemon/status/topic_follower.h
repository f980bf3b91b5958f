// TopicFollower: receives topics of one role without ever waiting, for a server that shows them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::status {

// Thread-bound. Uses a thread of ZeroMQ's.
class TopicFollower {
 public:
  explicit TopicFollower(std::vector<std::string> topics);
  ~TopicFollower();
  TopicFollower(const TopicFollower&) = delete;
  TopicFollower& operator=(const TopicFollower&) = delete;

  // Follows the publisher at this address instead of the previous one; empty: follows none. Does
  // nothing if the address is the same as before. Succeeds also if nobody publishes there yet.
  // Errors: kIo.
  Result<Ok> connect(const std::string& status_endpoint);

  struct Message {
    std::string topic, document;
  };
  // Returns the next document that has arrived; nothing if there is none. At most 100 are kept; if
  // more arrive between two calls, they are lost. A document is at most 1 MiB long.
  std::optional<Message> take();

 private:
  struct Connection;
  std::vector<std::string> topics_;
  std::unique_ptr<Connection> connection_;
};

}  // namespace merlin::status
