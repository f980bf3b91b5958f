// WallTuning: settings that a wall takes while it runs.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/wall/input_feed.h"
#include "daemon/wall/settings.h"
#include "render/governor/settings.h"
#include "render/scene/settings.h"

namespace merlin::wall {

// A member without a value leaves its setting as it is.
struct WallTuning {
  std::optional<render::governor::GovernorSettings> governor;
  std::optional<PlaylistSettings> playlist;
  std::vector<std::size_t> places;  // of playlist->contents, in order; empty: all in turn
  std::optional<render::scene::SceneSettings> scene;
  std::optional<FeedSettings> feed;
};

}  // namespace merlin::wall
