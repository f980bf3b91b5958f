// merlin wall: triangles and rate by hand, until they are given back.
#include <memory>

#include <fmt/format.h>

#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"
#include "daemon/status/client.h"

namespace merlin::cli {
namespace {

constexpr Duration kPatience = std::chrono::seconds(2);

struct WallOptions {
  std::string instance = "merlin";
  std::string triangles, rate;
};

int wall(const WallOptions& options) {
  if (options.triangles.empty() && options.rate.empty())
    return fail({Errc::kInvalidArgument, "wall: nothing to set; give --triangles or --rate"});
  const auto roles = findRoles(options.instance);
  if (!roles) return fail(roles.error());
  for (const FoundRole& role : *roles) {
    if (role.role != "wall") continue;
    for (const auto& [name, value] :
         {std::pair{"triangles", options.triangles}, std::pair{"rate", options.rate}}) {
      if (value.empty()) continue;
      const auto done = status::ask(role.endpoints.command, name, kPatience, value);
      if (!done) return fail(done.error());
      say("{}: {}\n", name, value);
    }
    return kExitDone;
  }
  return fail({Errc::kIo, fmt::format("no merlind shows a wall as \"{}\"", options.instance)});
}

}  // namespace

void addWall(Command app, Run& run) {
  const auto options = std::make_shared<WallOptions>();
  Command command =
      app.subcommand("wall",
                     "Triangles and rate by hand, until auto gives them back to the governor.\n"
                     "Example: merlin wall --triangles 20000 --rate 20");
  addInstance(command, options->instance);
  command.option("--triangles", options->triangles, "While it moves, or auto").typeName("N|auto");
  command.option("--rate", options->rate, "Frames a second, or auto: as configured")
      .typeName("HZ|auto");
  command.callback([options, &run] { run = [options] { return wall(*options); }; });
}

}  // namespace merlin::cli
