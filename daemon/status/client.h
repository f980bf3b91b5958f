// The client of StatusServer, for `merlin`: sends commands and follows topics.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"

namespace merlin::status {

// Sends {"command": name}, with "argument" if it is not empty; returns the JSON text of "result".
// Errors: kTimeout (no answer), kInvalidArgument (the daemon refused the command), kIo. If the
// daemon closes the connection (all places taken), the request is lost; `status`, which changes
// nothing, is therefore sent again every second until `timeout`.
Result<std::string> ask(const std::string& command_endpoint, const std::string& command,
                        Duration timeout, const std::string& argument = "");

// Sends commands one after another and never waits for an answer. Uses a thread of ZeroMQ's.
// Thread-bound.
class CommandSender {
 public:
  CommandSender();
  ~CommandSender();
  CommandSender(const CommandSender&) = delete;
  CommandSender& operator=(const CommandSender&) = delete;

  // Whether the last command was answered; only then another one can be sent.
  bool isReady() const noexcept;
  // Sends {"command": name}, with "argument" if it is not empty. REQUIRES: isReady(). Errors: kIo.
  Result<Ok> send(const std::string& command_endpoint, const std::string& command,
                  const std::string& argument, Timestamp now);
  // The answer to the last command, once: the JSON text of "result"; nothing while there is none.
  // Errors: kTimeout (no answer within kPatience), kInvalidArgument (the daemon refused the
  // command), kIo.
  std::optional<Result<std::string>> answer(Timestamp now);

  static constexpr Duration kPatience = std::chrono::seconds(2);

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

// Calls `take` with each document of these topics, from all endpoints, until it returns false.
// Errors: kTimeout (nothing was received for `patience`), kIo.
Result<Ok> follow(
    const std::vector<std::string>& status_endpoints, const std::vector<std::string>& topics,
    Duration patience,
    const std::function<bool(const std::string& topic, const std::string& document)>& take);

}  // namespace merlin::status
