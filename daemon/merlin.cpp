// merlin: everything that a person types.
#include <CLI/CLI.hpp>

#include "daemon/base/log.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"

int main(int argc, char** argv) {
  using namespace merlin;
  CLI::App app("MERLIN: a lab's display wall. The daemon is merlind.");
  app.require_subcommand(1);
  app.set_version_flag("--version", MERLIN_VERSION);
  cli::Run run;
  for (const auto add : {cli::addStatus, cli::addWatch, cli::addSnapshot, cli::addMesh, cli::addPosture, cli::addEmulate, cli::addShm}) {
    add(app, run);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kExitDone : kExitBadInput;
  }
  initLog(LogLevel::kWarning);
  return run();
}
