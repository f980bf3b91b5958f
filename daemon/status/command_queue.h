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
  // `id`: the caller's, for the answer.
  struct Waiting {
    std::uint64_t id = 0;
    std::string command, argument;
    Timestamp until{};  // the command is given up at this time
  };
  // The JSON text of the command's result. Errors: kTimeout, kInvalidArgument (the role refused
  // it), kIo, kNotFound (the role does not run).
  using Answered = std::function<void(std::uint64_t id, const Result<std::string>& answer)>;

  // Adds a command. Returns false if kMostWaiting commands wait already.
  bool add(Waiting command);
  // Sends what can be sent to `command_endpoint` (empty: the role does not run) and passes answers
  // on.
  void update(const std::string& command_endpoint, Timestamp now, const Answered& answered);

  static constexpr std::size_t kMostWaiting = 16;

 private:
  CommandSender sender_;
  std::deque<Waiting> waiting_;
  std::optional<std::uint64_t> sent_;  // the command whose answer is outstanding
  std::string endpoint_;               // where it was sent
};

}  // namespace merlin::status
