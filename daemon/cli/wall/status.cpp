// merlin status: prints the status of the daemon once.
#include <memory>

#include <fmt/format.h>

#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/remote.h"
#include "daemon/cli/wall/status_text.h"

namespace merlin::cli {

void addStatus(Command app, Run& run, RemoteOptions& remote) {
  struct Options {
    std::string instance = "merlin";
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  Command command = app.subcommand(
      "status", "Show the state of the wall and of the devices.\nExample: merlin status --json");
  addInstance(command, options->instance);
  command.flag("--json", options->json, "Print JSON, for programs");
  command.callback([options, &run, &remote] {
    run = [options, daemon = remote.daemon(options->instance)] {
      const auto status = askStatus(daemon);
      if (!status) return fail(status.error());
      printOut("{}", options->json ? status->dump(2) + "\n" : statusTable(*status));
      return kExitDone;
    };
  });
}

}  // namespace merlin::cli
