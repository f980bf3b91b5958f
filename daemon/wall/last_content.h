// LastContent: which content was shown last, in the daemon's state.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/state/state_keeper.h"
#include "daemon/wall/missing_contents.h"
#include "daemon/wall/wall_contents.h"

namespace merlin::wall {

// The state stores an empty path for the first content, so that the configuration decides which one
// it is, and the absolute path of any other one. Earlier versions stored a relative path if
// --config was relative; it means the content whose path ends with it. Not thread-safe, but first()
// may run beside keep().
class LastContent {
 public:
  // `missing`: of `entries`, the contents of the configuration. All outlive this object.
  LastContent(const std::vector<ContentEntry>& entries, const MissingContents& missing,
              state::StateKeeper& keeper)
      : entries_(entries), missing_(missing), keeper_(keeper) {}

  // The place of the content to begin with. Adds a notice to those of the state if the
  // configuration lacks the content that was shown last.
  std::size_t first() const;

  // Saves that the content of this place is shown; a place beyond the configured contents, i.e. a
  // file, is not saved. Cheap if the place is that of the last call.
  void keep(std::size_t place);

 private:
  std::optional<std::size_t> placeInState() const;

  const std::vector<ContentEntry>& entries_;
  const MissingContents& missing_;
  state::StateKeeper& keeper_;
  std::optional<std::size_t> kept_;  // place of the last keep()
};

}  // namespace merlin::wall
