// merlin reset_view, merlin projector_on ...: the commands of daemon/base/commands.h that take no
// argument and have no other subcommand.
#include <memory>

#include <fmt/format.h>

#include "daemon/base/commands.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/roles.h"

namespace merlin::cli {
namespace {

int send(const std::string& instance, const CommandInfo& command) {
  const auto done = askRole(instance, command.role == CommandOf::kWall ? "wall" : "devices",
                            {std::string(command.name)});
  return done ? kExitDone : fail(done.error());
}

}  // namespace

void addCommandsByName(Command app, Run& run) {
  for (const CommandInfo& info : kCommands) {
    if (!info.by_name) continue;
    const auto instance = std::make_shared<std::string>("merlin");
    Command command = app.subcommand(std::string(info.name),
                                     fmt::format("{}\nExample: merlin {}", info.help, info.name));
    addInstance(command, *instance);
    command.callback(
        [instance, &info, &run] { run = [instance, &info] { return send(*instance, info); }; });
  }
}

}  // namespace merlin::cli
