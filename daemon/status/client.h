// The client of StatusServer, for `merlin`: sends commands and follows topics.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/status/curve.h"

namespace merlin::status {

// Keys of an encrypted connection to a server on another machine.
struct ClientKeys {
  std::string server_key;  // the server's public key
  KeyPair own;             // the client's own keys; the server lists the public one
};

// Address at which a role accepts commands.
struct CommandAddress {
  std::string endpoint;            // "ipc://PATH"; with keys "tcp://HOST:PORT"
  std::optional<ClientKeys> keys;  // none: not encrypted

  CommandAddress(std::string at, std::optional<ClientKeys> by = std::nullopt)  // NOLINT: implicit
      : endpoint(std::move(at)), keys(std::move(by)) {}
  bool operator==(const CommandAddress& other) const;
};

// Sends {"command": name}, with "argument" if it is not empty; returns the JSON text of "result".
// Errors: kTimeout (no answer), kInvalidArgument (the daemon refused the command), kIo. If the
// daemon closes the connection (all places taken), the request is lost; `status`, which changes
// nothing, is therefore sent again every second until `timeout`.
Result<std::string> ask(const CommandAddress& server, const std::string& command, Duration timeout,
                        const std::string& argument = "");

// Sends commands one after another and never waits for an answer. Uses a thread of ZeroMQ's.
// Thread-bound.
class CommandSender {
 public:
  CommandSender();
  ~CommandSender();
  CommandSender(const CommandSender&) = delete;
  CommandSender& operator=(const CommandSender&) = delete;

  // Whether no answer is outstanding; only then a command can be sent.
  bool isReady() const noexcept;
  // Sends {"command": name}, with "argument" if it is not empty. If the message cannot be sent
  // without waiting, it is dropped and isReady() stays true. REQUIRES: isReady(). Errors: kIo.
  Result<Ok> send(const CommandAddress& server, const std::string& command,
                  const std::string& argument, Timestamp now);
  // Returns the answer to the last command once, as the JSON text of "result"; nothing while it is
  // outstanding. Errors: kTimeout (no answer within kPatience), kInvalidArgument (the daemon
  // refused the command), kIo.
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
