#include "daemon/cli/command.h"

#include <cstdio>

#include <fmt/format.h>

#include "daemon/cli/exit_status.h"

namespace merlin::cli {

int fail(const Error& error) {
  fmt::print(stderr, "merlin: {}\n", error.what);
  return exitStatus(error);
}

void addInstance(Command app, std::string& instance) {
  app.option("--instance", instance, "Which daemon, by the \"instance\" of its configuration")
      .showDefault();
}

}  // namespace merlin::cli
