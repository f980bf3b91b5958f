// The options of `merlin` that name a daemon on another machine.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/cli/command.h"
#include "daemon/cli/roles.h"

namespace merlin::cli {

// The options before the subcommand: merlin --endpoint ... --keys ... --server-key ... COMMAND. The
// object must outlive the execution of the subcommand; its values are valid after parsing.
class RemoteOptions {
 public:
  // Adds the options to the program's own.
  explicit RemoteOptions(Command app);
  ~RemoteOptions() = default;
  RemoteOptions(const RemoteOptions&) = delete;
  RemoteOptions& operator=(const RemoteOptions&) = delete;

  // Returns the daemon that the subcommand communicates with, and marks the options as supported
  // (check()). To be called by the callback of a subcommand that can use a daemon on another
  // machine. `instance`: name of the daemon on this machine.
  DaemonAddress daemon(const std::string& instance);

  // Checks, after parsing, that the given subcommand supports these options if they were given.
  // Errors: kInvalidArgument.
  Result<Ok> check() const;

 private:
  DaemonAddress address_;
  bool used_ = false;
};

}  // namespace merlin::cli
