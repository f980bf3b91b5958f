// merlin: the command-line program; its subcommands are in daemon/cli.
#include <csignal>

#include <CLI/CLI.hpp>

#include "daemon/base/log.h"
#include "daemon/base/version.h"
#include "daemon/cli/command.h"
#include "daemon/cli/parse_arguments.h"
#include "daemon/cli/remote.h"

namespace merlin {
namespace {

manual::PageSettings page() {
  return {.name = "merlin",
          .summary = "command-line tool of the display wall MERLIN",
          .section = 1,
          .files = {{"/etc/merlin/merlin.json", "the daemon's configuration"},
                    {"/var/lib/merlin", "models, and what people changed while the wall ran"}},
          .see_also = {"merlind(8)", "merlin.json(5)"}};
}

int runProgram(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding a file-size limit is then an error of write()
  CLI::App app(
      "MERLIN runs a lab's display wall. This is its command-line tool; the daemon is merlind.");
  app.require_subcommand(1);
  app.set_version_flag("--version", programVersion());
  cli::Run run;
  const cli::Command program(app);
  cli::RemoteOptions remote(program);
  for (const auto add : {cli::addStatus, cli::addWatch}) add(program, run, remote);
  for (const auto add :
       {cli::addDevices, cli::addSnapshot, cli::addWall, cli::addShow, cli::addTrace, cli::addMesh,
        cli::addImage, cli::addPosture, cli::addGesture, cli::addEmulate, cli::addRecord,
        cli::addReplay, cli::addFlight, cli::addReload, cli::addReport, cli::addCalibrate,
        cli::addConfig, cli::addKeys, cli::addShm}) {
    add(program, run);
  }
  cli::addCommandsByName(program, run, remote);
  if (const auto status = parseArguments(app, argc, argv, page())) return *status;
  if (const auto possible = remote.check(); !possible) return cli::fail(possible.error());
  initLog(LogLevel::kWarning);
  return run();
}

}  // namespace
}  // namespace merlin

int main(int argc, char** argv) {
  merlin::openStandardStreams();
  return merlin::runGuarded("merlin", [&] { return merlin::runProgram(argc, argv); });
}
