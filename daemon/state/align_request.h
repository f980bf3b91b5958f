// Parses the argument of the command `align`, and formats the answer to it as JSON. Pure.
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
// Selects the corner that bound inputs (align_left ...) move from then on.
struct SelectRequest {
  std::string output;
  Place place;
};
struct UndoRequest {};
struct RedoRequest {};
using AlignRequest =
    std::variant<ListRequest, MoveRequest, ResetRequest, SelectRequest, UndoRequest, RedoRequest>;

// All forms of the argument, for messages. The name of an output comes last, since it may contain
// spaces.
inline constexpr const char* kAlignForms =
    "list | move CORNER DX DY OUTPUT | point COLUMN ROW DX DY OUTPUT | select CORNER OUTPUT | "
    "reset OUTPUT | undo | redo";

// Parses the argument of the command `align`. Errors: kInvalidArgument; the message lists the
// allowed forms.
Result<AlignRequest> parseAlignRequest(std::string_view argument);

// Returns the argument of the command that parseAlignRequest() parses to this request.
std::string textOf(const AlignRequest& request);

// One output in the answer to `align`.
struct ReportedOutput {
  OutputForm form;
  std::vector<double> configured;  // configured offsets of its 4 corners: x, y of each [px]
  bool pending = false;            // whether its last change is not shown yet
  SeenAxes axes{};
};

struct AlignReport {
  std::vector<ReportedOutput> outputs;
  std::string selected;  // name of the selected output; empty if none can be aligned
  Place selected_place;
  std::string done;       // description of an undo or redo that was just executed; else empty
  std::string test_card;  // name of the test card that is shown; empty: none
};

// Returns the answer to the command `align`, a JSON object: {"outputs": [{"name", "width",
// "height", "mesh": [COLUMNS, ROWS], "pending", "seen": {"right": [X, Y], "down": [X, Y]},
// "corners": {"top_left": {"configured": [X, Y], "moved": [X, Y]}, ...}, "points": [{"column",
// "row", "moved": [X, Y]}]}], "selected": {"output", "place"}, "undo": N, "redo": N, "done": "",
// "test_card": ""}. "seen" has the directions of SeenAxes. All lengths are in pixels of the
// output's signal. REQUIRES: `configured` of each output has 8 elements.
std::string reportText(const AlignReport& report, const Alignment& alignment);

}  // namespace merlin::state
