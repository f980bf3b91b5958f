// SetAside: keeps alignments that do not fit their outputs at present until they fit again. Pure.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "daemon/state/alignment.h"

namespace merlin::state {

// Limits, so that the state file stays far below the maximum size of a JSON file.
inline constexpr std::size_t kMostAsideOfOutput = 4;  // maximum number of alignments of one output
inline constexpr std::size_t kMostAside = 64;         // maximum number of alignments of all outputs
// Maximum number of moved places, steps and changes, summed over all alignments. A single alignment
// may have as many places and changes together; its steps are then not counted.
inline constexpr std::size_t kMostAsideEntries = 4000;

// End of the message which says that an alignment is set aside.
inline constexpr const char* kComesBack =
    "it comes back, with its undo steps, when the output is again as it was then";

class SetAside {
 public:
  // Adds the alignment of one output as the newest one, unless Alignment::isNothing(). The oldest
  // alignments beyond the limits are removed. If `alignment` alone exceeds a limit, its oldest
  // steps are removed. REQUIRES: it has one output.
  void add(Alignment alignment);

  // Removes the newest alignment for which `fits` returns true, and returns this alignment; nothing
  // if there is none.
  std::optional<Alignment> take(const std::function<bool(const Alignment&)>& fits);

  // Returns the alignments, each of one output, oldest first.
  const std::vector<Alignment>& alignments() const { return alignments_; }

 private:
  std::vector<Alignment> alignments_;
};

}  // namespace merlin::state
