// LastContent: stores in the daemon's state which content was shown last, and finds this content at
// a start.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/state/state_keeper.h"
#include "daemon/wall/missing_contents.h"
#include "daemon/wall/wall_contents.h"

namespace merlin::wall {

// The state has an empty path for the first content of the configuration, so that the configuration
// decides which content this is, and the absolute path of any other content. Earlier versions
// stored a relative path if --config was relative; it stands for the content whose path ends with
// it. Not thread-safe, except that first() may run at the same time as keep().
class LastContent {
 public:
  // `entries`: the contents of the configuration. `missing`: which of them cannot be shown yet. All
  // arguments must outlive this object.
  LastContent(const std::vector<ContentEntry>& entries, const MissingContents& missing,
              state::StateKeeper& keeper)
      : entries_(entries), missing_(missing), keeper_(keeper) {}

  // Returns the place of the content that was shown last; 0, and a notice of the keeper, if the
  // configuration no longer has this content.
  std::size_t first() const;

  // Saves that the content of this place is shown. A place after those of the configured contents,
  // i.e. a file in the content folder, is not saved. Cheap if the place is the same as in the last
  // call.
  void keep(std::size_t place);

 private:
  std::optional<std::size_t> placeInState() const;

  const std::vector<ContentEntry>& entries_;
  const MissingContents& missing_;
  state::StateKeeper& keeper_;
  std::optional<std::size_t> kept_;  // place of the last keep()
};

}  // namespace merlin::wall
