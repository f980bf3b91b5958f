// WallTuning: settings that can be changed while the wall runs.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/wall/input_feed.h"
#include "daemon/wall/settings.h"
#include "render/governor/settings.h"
#include "render/scene/settings.h"

namespace merlin::wall {

// A member without a value does not change its setting.
struct WallTuning {
  std::optional<render::governor::GovernorSettings> governor;
  std::optional<PlaylistSettings> playlist;
  // Indexes of the contents in playlist->contents, in this order; empty: all contents in turn.
  std::vector<std::size_t> places;
  std::optional<render::scene::SceneSettings> scene;
  std::optional<FeedSettings> feed;
};

}  // namespace merlin::wall
