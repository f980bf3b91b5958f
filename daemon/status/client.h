// The other side of StatusServer, for `merlin`: ask a command, follow topics.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"

namespace merlin::status {

// Sends {"command": name}, with "argument" where there is one; returns the JSON text of "result".
// Errors: kTimeout (the daemon is there and does not answer), kIo; what the daemon refused,
// kInvalidArgument. A connection that the daemon closed (strangers held every place) takes a
// request with it: `status`, which changes nothing, is asked again every second until `timeout`.
Result<std::string> ask(const std::string& command_endpoint, const std::string& command,
                        Duration timeout, const std::string& argument = "");

// Calls `take` with each document of these topics, from all endpoints, until it returns false or
// nothing has come for `patience` (kTimeout). Errors: kIo, kTimeout.
Result<Ok> follow(
    const std::vector<std::string>& status_endpoints, const std::vector<std::string>& topics,
    Duration patience,
    const std::function<bool(const std::string& topic, const std::string& document)>& take);

}  // namespace merlin::status
