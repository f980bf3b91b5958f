// merlin wall: sets triangles and rate by hand.
#include <memory>

#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"

namespace merlin::cli {
namespace {

struct WallOptions {
  std::string instance = "merlin";
  std::string triangles, rate;
};

int wall(const WallOptions& options) {
  if (options.triangles.empty() && options.rate.empty())
    return fail({Errc::kInvalidArgument, "wall: nothing to set; give --triangles or --rate"});
  for (const auto& [name, value] :
       {std::pair{"triangles", options.triangles}, std::pair{"rate", options.rate}}) {
    if (value.empty()) continue;
    const auto done = askRole(options.instance, "wall", {name, value});
    if (!done) return fail(done.error());
    say("{}: {}\n", name, value);
  }
  return kExitDone;
}

}  // namespace

void addWall(Command app, Run& run) {
  const auto options = std::make_shared<WallOptions>();
  Command command =
      app.subcommand("wall",
                     "Set triangles and rate by hand; auto returns the control to the governor.\n"
                     "Example: merlin wall --triangles 20000 --rate 20");
  addInstance(command, options->instance);
  command
      .option("--triangles", options->triangles,
              "Number of triangles while anything moves, or auto")
      .typeName("N|auto");
  command.option("--rate", options->rate, "Frames per second, or auto for the configured rate")
      .typeName("HZ|auto");
  command.callback([options, &run] { run = [options] { return wall(*options); }; });
}

}  // namespace merlin::cli
