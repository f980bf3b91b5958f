// merlin reset_view, merlin playlist on ...: adds a subcommand for each command of
// daemon/base/commands.h that has no subcommand of its own.
#include <memory>

#include <fmt/format.h>

#include "daemon/base/commands.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/remote.h"

namespace merlin::cli {
namespace {

struct Sent {
  std::string instance = "merlin", argument;
};

int send(const DaemonAddress& daemon, const Sent& sent, const CommandInfo& command) {
  const auto done = askRole(daemon, command.role == CommandOf::kWall ? "wall" : "devices",
                            {std::string(command.name), sent.argument});
  return done ? kExitDone : fail(done.error());
}

// Returns the first of the allowed words: "on" for "on|off".
std::string_view firstWord(std::string_view argument) {
  return argument.substr(0, argument.find('|'));
}

// Returns the allowed words as a text: "on, off or next" for "on|off|next".
std::string choices(std::string_view argument) {
  std::string text(argument);
  const std::size_t last = text.rfind('|');
  if (last != std::string::npos) text.replace(last, 1, " or ");
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos;)
    text.replace(at, 1, ", ");
  return text;
}

}  // namespace

void addCommandsByName(Command app, Run& run, RemoteOptions& remote) {
  for (const CommandInfo& info : kCommands) {
    if (!info.by_name) continue;
    const auto sent = std::make_shared<Sent>();
    Command command =
        app.subcommand(std::string(info.name),
                       fmt::format("{}\nExample: merlin {}{}{}", info.help, info.name,
                                   info.argument.empty() ? "" : " ", firstWord(info.argument)));
    addInstance(command, sent->instance);
    if (!info.argument.empty()) {
      command.option("argument", sent->argument, "What to do").typeName(std::string(info.argument));
    }
    command.callback([sent, &info, &run, &remote] {
      if (!info.argument.empty() && sent->argument.empty()) lacks(choices(info.argument));
      run = [sent, &info, daemon = remote.daemon(sent->instance)] {
        return send(daemon, *sent, info);
      };
    });
  }
}

}  // namespace merlin::cli
