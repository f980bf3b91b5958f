#include "daemon/cli/wall/align.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"
#include "daemon/cli/wall/align_session.h"
#include "daemon/cli/wall/aligned_wall.h"
#include "daemon/cli/wall/raw_terminal.h"

namespace merlin::cli {
namespace {

struct AlignOptions {
  std::string instance = "merlin";
  std::string output, corner;
  std::vector<int> point;  // column and row
  std::vector<double> by;  // [px]
  bool undo = false, redo = false, reset = false, list = false, json = false;
};

Error usage(const std::string& what) {
  return {Errc::kInvalidArgument, fmt::format("wall align: {}", what)};
}

Result<state::AlignRequest> moveRequest(const AlignOptions& o) {
  if (o.output.empty()) return usage("--by needs --output NAME");
  if (o.corner.empty() == o.point.empty())
    return usage("--by needs --corner NAME or --point COLUMN ROW");
  const state::Place place = o.point.empty()
                                 ? *state::cornerNamed(o.corner)
                                 : state::Place{state::Place::Of::kMesh, o.point[0], o.point[1]};
  return state::AlignRequest{state::MoveRequest{o.output, place, {o.by[0], o.by[1]}}};
}

Result<state::AlignRequest> requestOf(const AlignOptions& o) {
  if (!o.by.empty()) return moveRequest(o);
  if (!o.corner.empty() || !o.point.empty()) return usage("--corner and --point need --by DX DY");
  if ((o.undo || o.redo) && !o.output.empty())
    return usage(fmt::format(
        "{}, whichever output it moved; leave --output out, or move {} with --by",
        o.undo ? "--undo takes back the last step" : "--redo repeats the step that was undone last",
        o.output));
  if (o.undo) return state::AlignRequest{state::UndoRequest{}};
  if (o.redo) return state::AlignRequest{state::RedoRequest{}};
  if (o.reset && o.output.empty()) return usage("--reset needs --output NAME");
  if (o.reset) return state::AlignRequest{state::ResetRequest{o.output}};
  return state::AlignRequest{state::ListRequest{}};
}

Error unknownOutput(const std::string& name, const AlignAnswer& answer) {
  std::string known;
  for (const AlignedPicture& output : answer.outputs)
    known += (known.empty() ? "" : ", ") + output.name;
  return usage(fmt::format("\"{}\" is not an output that can be aligned; there are {}", name,
                           known.empty() ? "none" : known));
}

int print(const AlignOptions& options, AlignAnswer answer) {
  if (options.json) {
    fmt::print("{}\n", answer.text);
    return kExitDone;
  }
  if (!answer.done.empty()) printOut("{}: {}\n", options.undo ? "undone" : "redone", answer.done);
  if (answer.find(options.output))
    std::erase_if(answer.outputs, [&](const auto& o) { return o.name != options.output; });
  for (const std::string& line : alignmentLines(answer)) printOut("{}\n", line);
  return kExitDone;
}

// Returns whether the command is controlled by keys: no option for scripts was given, and there is
// a terminal.
bool isInteractive(const AlignOptions& o) {
  const bool scripted = !o.by.empty() || !o.corner.empty() || !o.point.empty() || o.undo ||
                        o.redo || o.reset || o.list || o.json;
  return !scripted && RawTerminal::check();
}

int alignByKeys(const AlignOptions& options) {
  const AlignedWall wall(options.instance);
  AlignSession session({[&](const state::AlignRequest& request) { return wall.ask(request); },
                        [&](const std::string& card) -> Result<Ok> {
                          const auto shown = askRole(options.instance, "wall", {"testcard", card});
                          if (!shown) return wallsReason(shown.error(), "testcard");
                          return Ok{};
                        }},
                       options.output);
  if (const auto begun = session.begin(); !begun) return fail(begun.error());
  constexpr int kRefresh_ms = 500;
  RawTerminal terminal;
  AlignKeyReader keys;
  for (;;) {
    terminal.show(session.screen());
    const auto bytes = terminal.read(kRefresh_ms);
    if (!bytes) return kExitDone;
    if (bytes->empty()) session.refresh();
    for (const AlignKey& key : keys.feed(*bytes)) {
      if (!session.press(key)) return kExitDone;
    }
  }
}

int align(const AlignOptions& options) {
  if (isInteractive(options)) return alignByKeys(options);
  const auto request = requestOf(options);
  if (!request) return fail(request.error());
  auto answer = AlignedWall(options.instance).askAndWait(*request);
  if (!answer) return fail(answer.error());
  if (!options.output.empty() && !answer->find(options.output))
    return fail(unknownOutput(options.output, *answer));
  return print(options, *std::move(answer));
}

void addChoices(Command command, AlignOptions& options) {
  Command choices = command.group("What to do", "");
  choices
      .option("--by", options.by,
              "Move the corner or point right by DX and down by DY pixels of the output; negative "
              "values move it left and up. Fractions are allowed")
      .expected(2)
      .typeName("DX DY")
      .range(-state::kMostOffset, state::kMostOffset);
  choices.flag("--undo", options.undo, "Undo the last step, of any output; the last 100 are kept");
  choices.flag("--redo", options.redo, "Redo the step that was undone last");
  choices.flag(
      "--reset", options.reset,
      "Move all corners and points of the output back to where the configuration has them");
  choices.flag("--list", options.list,
               "Only show where the corners are, of all outputs or of --output");
  choices.atMostOne();
}

}  // namespace

void addAlign(Command wall, Run& run) {
  const auto options = std::make_shared<AlignOptions>();
  Command command = wall.subcommand(
      "align",
      "Move the corners of the picture that an output shows, while the wall runs: in a terminal "
      "with keys, which are shown there; by a script with --by, --undo, --redo, --reset. Changes "
      "are shown at once and are kept after a restart; they are added to the configuration's "
      "correction, and the configuration stays as it is. A test card helps: merlin wall testcard "
      "grid.\nExample: merlin wall align --output left --corner top_left --by 2.5 -1");
  addInstance(command, options->instance);
  command.option("--output", options->output, "Name of the output, as in merlin status")
      .typeName("NAME");
  command
      .option(
          "--corner", options->corner,
          "The corner to move, named as in the picture that is sent to the output, after mirror "
          "and turn_deg (keys and the web page name corners as they are seen on the wall)")
      .oneOf({std::begin(state::kCornerNames), std::end(state::kCornerNames)});
  command
      .option("--point", options->point,
              "Instead of a corner: a point of the output's mesh, counted from 0")
      .expected(2)
      .typeName("COLUMN ROW")
      .range(0, 63);
  addChoices(command, *options);
  command.flag("--json", options->json, "Print where the corners are as JSON");
  command.callback([options, &run] { run = [options] { return align(*options); }; });
}

}  // namespace merlin::cli
