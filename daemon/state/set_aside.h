// SetAside: alignments that do not fit their outputs at present, kept for when they fit again.
// Pure.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "daemon/state/alignment.h"

namespace merlin::state {

// Limits, so that the state file stays far below what a file of JSON may have.
inline constexpr std::size_t kMostAsideOfOutput = 4;  // alignments of one output
inline constexpr std::size_t kMostAside = 64;         // alignments of all outputs
// Moved places, steps and their changes, of all together. A single alignment may have this many
// places and changes, and its steps besides.
inline constexpr std::size_t kMostAsideEntries = 4000;

// For messages: the end of the sentence which says that an alignment is set aside.
inline constexpr const char* kComesBack =
    "it comes back, with its undo steps, when the output is again as it was then";

class SetAside {
 public:
  // Adds the alignment of one output, as the newest one. Beyond the limits the oldest ones are
  // forgotten, of a single one the oldest steps. An alignment that is nothing is not added.
  void add(Alignment alignment);

  // Removes the newest alignment that `fits`, and returns it; nothing if there is none.
  std::optional<Alignment> take(const std::function<bool(const Alignment&)>& fits);

  // Each of one output; the oldest first.
  const std::vector<Alignment>& alignments() const { return alignments_; }

 private:
  std::vector<Alignment> alignments_;
};

}  // namespace merlin::state
