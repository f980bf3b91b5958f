// CommandQueue: sends commands to one role, one after another, without ever waiting.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/status/client.h"

namespace merlin::status {

// Thread-bound.
class CommandQueue {
 public:
  // A command that waits. `id`: a number of the caller's choice, which Answered gets with the
  // answer.
  struct Waiting {
    std::uint64_t id = 0;
    std::string command, argument;
    Timestamp until{};  // if not sent by this time, the command fails: kTimeout
  };
  // Called once for each command, with the JSON text of its result. Errors: kTimeout,
  // kInvalidArgument (the role refused it), kIo, kNotFound (the role does not run).
  using Answered = std::function<void(std::uint64_t id, const Result<std::string>& answer)>;

  // Adds a command. Returns false if kMostWaiting commands wait already.
  bool add(Waiting command);
  // Calls `answered` for each command that was answered or has failed, and sends the next command
  // if none is outstanding. `command_endpoint`: where the role takes commands; empty: the role does
  // not run, so all waiting commands fail.
  void update(const std::string& command_endpoint, Timestamp now, const Answered& answered);

  static constexpr std::size_t kMostWaiting = 16;

 private:
  CommandSender sender_;
  std::deque<Waiting> waiting_;
  std::optional<std::uint64_t> sent_;  // the command whose answer is outstanding
  std::string endpoint_;               // where it was sent
};

}  // namespace merlin::status
