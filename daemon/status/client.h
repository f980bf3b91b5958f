// The client of StatusServer, for `merlin`: sends commands and follows topics.
#pragma once

#include <functional>
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

// Calls `take` with each document of these topics, from all endpoints, until it returns false.
// Errors: kTimeout (nothing was received for `patience`), kIo.
Result<Ok> follow(
    const std::vector<std::string>& status_endpoints, const std::vector<std::string>& topics,
    Duration patience,
    const std::function<bool(const std::string& topic, const std::string& document)>& take);

}  // namespace merlin::status
