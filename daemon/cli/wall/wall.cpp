// merlin wall: sets the number of triangles and the frame rate by hand, and moves the model.
#include <memory>

#include <nlohmann/json.hpp>

#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"
#include "daemon/cli/wall/align.h"
#include "daemon/cli/wall/gpus.h"
#include "daemon/cli/wall/mpcdi.h"
#include "daemon/cli/wall/wall_plan.h"

namespace merlin::cli {
namespace {

struct WallOptions {
  std::string instance = "merlin";
  std::string triangles, rate, move;
};

// Prints the value that the wall uses according to its answer, which may differ from the given one.
void printSet(const char* name, const std::string& value, const std::string& answer) {
  const auto json = nlohmann::json::parse(answer, nullptr, false);
  const bool says = json.is_object() && json.contains("used");
  const std::string used = says ? json["used"].dump() : value;
  if (used == value)
    printOut("{}: {}\n", name, value);
  else
    printOut("{}: {} ({} is outside of what can be used)\n", name, used, value);
}

int wall(const WallOptions& options) {
  if (options.triangles.empty() && options.rate.empty() && options.move.empty()) {
    return fail(
        {Errc::kInvalidArgument, "wall: nothing to do; give --triangles, --rate or --move"});
  }
  for (const auto& [name, value] :
       {std::pair{"triangles", options.triangles}, std::pair{"rate", options.rate},
        std::pair{"move", options.move}}) {
    if (value.empty()) continue;
    const auto done = askRole(options.instance, "wall", {name, value});
    if (!done) return fail(done.error());
    printSet(name, value, *done);
  }
  return kExitDone;
}

}  // namespace

void addWall(Command app, Run& run) {
  const auto options = std::make_shared<WallOptions>();
  Command command = app.subcommand(
      "wall",
      "Set the number of triangles per frame and the frame rate by hand; with auto "
      "merlind controls the triangles again, or uses the configured rate. plan: "
      "the wall from above; mpcdi: the corrections of outputs, as files; align: moves the "
      "corners of outputs while the wall runs; testcard: a grid, ramps and the like instead of the "
      "picture; gpus: the GPUs that it may be drawn on.\n"
      "Example: merlin wall --triangles 20000 --rate 20");
  addInstance(command, options->instance);
  command
      .option(
          "--triangles", options->triangles,
          "Number of triangles per frame while anything moves, from /wall/rate/min_triangles to "
          "/wall/rate/max_triangles (for a picture: its least detail, in its own unit), or auto")
      .typeName("N|auto");
  command.option("--rate", options->rate, "Frames per second, or auto for the configured rate")
      .typeName("HZ|auto");
  command
      .option("--move", options->move,
              "Move what the ball moves, at once: X Y Z times the model's radius to the right, up "
              "and towards the viewer, and RX RY RZ degrees about these axes, as one argument, "
              "--move=\"0 0 0 0 30 0\"")
      .typeName("\"X Y Z RX RY RZ\"");
  addAlign(command, run);
  addPlan(command, run);
  addTestcard(command, run);
  addMpcdi(command, run);
  addGpus(command, run);
  // CLI11 calls the callback of a subcommand first and then this one, which must not replace what
  // that one has set.
  command.callback([options, &run] {
    if (!run) run = [options] { return wall(*options); };
  });
}

}  // namespace merlin::cli
