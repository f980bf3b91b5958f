// AlignedWall: accesses the alignment of a running wall through its socket.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/state/align_request.h"

namespace merlin::cli {

// The answer of the command `align`, parsed.
struct AlignedCorner {
  state::Offset configured, moved;  // [px]
};
struct AlignedPoint {  // a point of the mesh
  int column = 0, row = 0;
  state::Offset moved;  // [px]
};
struct AlignedPicture {
  std::string name;
  int width = 0, height = 0;
  bool pending = false;
  std::array<AlignedCorner, 4> corners;   // in the order of state::kCornerNames
  std::vector<AlignedPoint> points = {};  // only those that are moved
  state::SeenAxes axes{};
  int mesh_columns = 0, mesh_rows = 0;  // 0: no mesh

  // Whether anything of this output is not at its configured position.
  bool isMoved() const;
};
struct AlignAnswer {
  std::vector<AlignedPicture> outputs;
  std::size_t undo = 0, redo = 0;  // number of steps
  std::string done;                // what an undo or redo did
  std::string text;                // the JSON

  const AlignedPicture* find(const std::string& output) const;
};

// Thread-bound.
class AlignedWall {
 public:
  explicit AlignedWall(std::string instance) : instance_(std::move(instance)) {}

  // Errors: those of askRole(), of a request that the wall refused only the reason (wallsReason());
  // kMalformed: not an answer of this version.
  Result<AlignAnswer> ask(const state::AlignRequest& request) const;

  // The same, then waits until all outputs show the change, 60 s at most. Errors: kTimeout.
  Result<AlignAnswer> askAndWait(const state::AlignRequest& request) const;

 private:
  std::string instance_;
};

// An error of askRole(), without the socket's address and the command, by which the message of a
// refused request begins.
Error wallsReason(Error error, std::string_view command);

// Reads the answer. Errors: kMalformed.
Result<AlignAnswer> readAlignAnswer(const std::string& text);

// A line for each output, corner and moved point, for people.
std::vector<std::string> alignmentLines(const AlignAnswer& answer);

}  // namespace merlin::cli
