// The argument of the command `align`, and the answer to it, which is JSON. Pure.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/state/alignment.h"
#include "daemon/state/seen_axes.h"

namespace merlin::state {

struct ListRequest {};
struct MoveRequest {
  std::string output;
  Place place;
  Offset by;
};
struct ResetRequest {
  std::string output;
};
// Selects the place that actions of bound inputs move from then on.
struct SelectRequest {
  std::string output;
  Place place;
};
struct UndoRequest {};
struct RedoRequest {};
using AlignRequest =
    std::variant<ListRequest, MoveRequest, ResetRequest, SelectRequest, UndoRequest, RedoRequest>;

// All forms, for messages. An output's name is last, since it may contain spaces.
inline constexpr const char* kAlignForms =
    "list | move CORNER DX DY OUTPUT | point COLUMN ROW DX DY OUTPUT | select CORNER OUTPUT | "
    "reset OUTPUT | undo | redo";

// Errors: kInvalidArgument, with what is allowed.
Result<AlignRequest> parseAlignRequest(std::string_view argument);

// The request as the command's argument.
std::string textOf(const AlignRequest& request);

// The alignment of one output.
struct ReportedOutput {
  OutputForm form;
  std::vector<double> configured;  // its corners in the configuration, x and y each
  bool pending = false;            // the last change is not shown yet
  SeenAxes axes{};
};

struct AlignReport {
  std::vector<ReportedOutput> outputs;
  std::string selected;  // name of an output; empty if none can be aligned
  Place selected_place;
  std::string done;       // what an undo or redo did; else empty
  std::string test_card;  // that is shown; else empty
};

// {"outputs": [{"name", "width", "height", "mesh": [COLUMNS, ROWS], "pending", "seen": {"right":
// [X, Y], "down": [X, Y]} (steps on the wall, in pixels of the signal), "corners":
// {"top_left": {"configured": [X, Y], "moved": [X, Y]}, ...}, "points": [{"column", "row", "moved":
// [X, Y]}]}], "selected": {"output", "place"}, "undo": N, "redo": N, "done": "", "test_card": ""};
// [px].
std::string reportText(const AlignReport& report, const Alignment& alignment);

}  // namespace merlin::state
