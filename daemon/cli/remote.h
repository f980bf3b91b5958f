// The options of `merlin` that name a daemon of another machine.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/cli/command.h"
#include "daemon/cli/roles.h"

namespace merlin::cli {

// The options given before the subcommand: merlin --endpoint ... --keys ... --server-key ...
// COMMAND. Valid once the command line has been parsed; must outlive the execution of the
// subcommand.
class RemoteOptions {
 public:
  // Adds the options to the program's own.
  explicit RemoteOptions(Command app);
  ~RemoteOptions() = default;
  RemoteOptions(const RemoteOptions&) = delete;
  RemoteOptions& operator=(const RemoteOptions&) = delete;

  // Returns the daemon that the subcommand communicates with. To be called by the callback of a
  // subcommand that can use another machine's daemon.
  DaemonAddress daemon(const std::string& instance);

  // Checks that the given subcommand supports these options. Errors: kInvalidArgument.
  Result<Ok> check() const;

 private:
  DaemonAddress address_;
  bool used_ = false;
};

}  // namespace merlin::cli
