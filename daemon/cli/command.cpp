#include "daemon/cli/command.h"

#include <cstdio>

#include <fmt/format.h>

#include "daemon/base/log.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"

namespace merlin::cli {

int fail(const Error& error) {
  printError("merlin: {}\n", printable(error.what));
  return exitStatus(error);
}

Result<Ok> checkEnding(const std::string& path, const char* what, const char* ending) {
  if (path.ends_with(ending)) return Ok{};
  return Error{Errc::kInvalidArgument,
               fmt::format("{}: the name of a {} must end in {}", path, what, ending)};
}

void addInstance(Command app, std::string& instance) {
  app.option("--instance", instance,
             "Name of the daemon: the setting instance of its configuration")
      .showDefault();
}

}  // namespace merlin::cli
