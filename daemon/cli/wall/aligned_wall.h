// AlignedWall: accesses the alignment of a running wall through its socket.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/state/align_request.h"

namespace merlin::cli {

// A corner of an output in the answer to the command `align`.
struct AlignedCorner {
  state::Offset configured, moved;  // [px]
};
struct AlignedPoint {  // a moved point of the warp mesh
  int column = 0, row = 0;
  state::Offset moved;  // [px]
};
// The alignment of one output.
struct AlignedPicture {
  std::string name;
  int width = 0, height = 0;
  bool pending = false;
  std::array<AlignedCorner, 4> corners;   // in the order of state::kCornerNames
  std::vector<AlignedPoint> points = {};  // only the moved points
  state::SeenAxes axes{};
  int mesh_columns = 0, mesh_rows = 0;  // 0: no mesh

  // Returns whether a corner or point of this output is not at its configured position.
  bool isMoved() const;
};
// The answer to the command `align`.
struct AlignAnswer {
  std::vector<AlignedPicture> outputs;
  std::size_t undo = 0, redo = 0;  // number of steps that can be undone and redone
  std::string done;                // sentence about what an undo or redo has done
  std::string text;                // the JSON text of the answer

  // Returns the output with this name; null if there is none. The pointer is into `outputs`.
  const AlignedPicture* find(const std::string& output) const;
};

// Thread-bound.
class AlignedWall {
 public:
  explicit AlignedWall(std::string instance) : instance_(std::move(instance)) {}

  // Sends the request and returns the answer. Errors: those of askRole(), reduced to the reason if
  // the wall has refused the request (wallsReason()); kMalformed (the answer is not of this
  // version).
  Result<AlignAnswer> ask(const state::AlignRequest& request) const;

  // Sends the request, then waits up to 60 s until all outputs show the change. Errors: those of
  // ask(); kTimeout.
  Result<AlignAnswer> askAndWait(const state::AlignRequest& request) const;

 private:
  std::string instance_;
};

// Returns the error of askRole(). If the wall has refused the request, the socket's address and the
// command are removed from the beginning of the text.
Error wallsReason(Error error, std::string_view command);

// Parses the answer to the command `align`. Errors: kMalformed.
Result<AlignAnswer> readAlignAnswer(const std::string& text);

// Returns a line for each output, corner and moved point, for people.
std::vector<std::string> alignmentLines(const AlignAnswer& answer);

}  // namespace merlin::cli
