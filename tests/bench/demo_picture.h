// The picture, tile plan and frame rate of the demo's wall, for benchmarks of outputs.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "daemon/base/clock.h"
#include "render/image/image_file.h"
#include "render/tiles/tile_plan.h"
#include "tests/bench/figures.h"

namespace merlin::bench {

inline constexpr double kRate_hz = 30;  // frame rate of the demo
// median drawing time of the demo, as a share of the period
inline constexpr double kDrawingShare = 0.65;

inline double msOf(Duration d) { return 1000 * toSeconds(d); }

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  // RGBA
};

// Returns the demo's picture; ends the benchmark if it cannot be read.
inline Picture demoPicture() {
  const auto read = render::image::readImage(MERLIN_SOURCE_DIR "/config/wall.png");
  if (!read) didNotRun("the picture", read.error().what, "run it in a source tree");
  Picture picture{read->width, read->height, {}};
  for (std::size_t i = 0; i < read->pixels.size(); i += 3) {
    picture.pixels.insert(picture.pixels.end(),
                          {read->pixels[i], read->pixels[i + 1], read->pixels[i + 2], 255});
  }
  return picture;
}

// Returns a plan with one tile that covers the whole picture.
inline render::tiles::TilePlan planOf(const Picture& picture) {
  render::tiles::TilesSettings settings;
  settings.frame_width = settings.tile_width = picture.width;
  settings.frame_height = settings.tile_height = picture.height;
  settings.tiles = {{"wall", render::tiles::TileKind::kWall, 0, 0, 0}};
  auto plan = render::tiles::planTiles(settings);
  if (!plan) didNotRun("the wall", plan.error().what, "fix the benchmark");
  return *std::move(plan);
}

}  // namespace merlin::bench
