#include "render/stereo/eye_tiles.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "render/tiles/tile_plan.h"

namespace merlin::render::stereo {
namespace {

using Eigen::Vector3d;

// The output shows the whole frame, so the tile stands for no placed tile.
constexpr std::size_t kWholeFrame = ~std::size_t{0};

std::string nameFor(tiles::Eye eye, const std::string& tile) {
  return fmt::format("{}.{}", tile, eye == tiles::Eye::kLeft ? 'L' : 'R');
}

// Returns the rectangle at this distance that fills the tile's frustum.
std::array<double, 9> screenAcross(const tiles::Tile& tile, double distance_m) {
  const Eigen::Matrix4d p = tile.projection.cast<double>();
  const Eigen::Matrix3d R_eye_view = tile.view.topLeftCorner<3, 3>().transpose().cast<double>();
  const auto corner = [&](double x, double y) {
    return Vector3d(distance_m *
                    (R_eye_view * Vector3d((p(0, 2) + x) / p(0, 0), (p(1, 2) + y) / p(1, 1), -1)));
  };
  std::array<double, 9> screen{};
  Eigen::Map<Eigen::Matrix3d> corners(screen.data());
  corners << corner(-1, -1), corner(1, -1), corner(-1, 1);
  return screen;
}

Vector3d eyesDirection(const StereoSettings& stereo, const tiles::TilePlan& plan) {
  const Vector3d configured(stereo.eyes_direction.data());
  if (!configured.isZero(0)) return configured.normalized();
  for (const tiles::Tile& t : plan.tiles) {
    const int middle = plan.wall_width / 2;
    if (t.followsWall() && t.wall_x <= middle && middle < t.wall_x + t.width)
      return t.view.block<1, 3>(0, 0).transpose().cast<double>().normalized();
  }
  return Vector3d::UnitX();
}

// Returns the tiles, each with a size of its own, and with a screen if it follows the wall.
tiles::TilesSettings withScreens(const tiles::TilesSettings& tiles, const tiles::TilePlan& plan,
                                 double distance_m) {
  tiles::TilesSettings wall = tiles;
  for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
    tiles::TileSettings& t = wall.tiles[i];
    t.width = plan.tiles[i].width;
    t.height = plan.tiles[i].height;
    if (!t.followsWall() || t.hasScreen()) continue;
    t.screen_m = screenAcross(plan.tiles[i], distance_m);
    t.turns = 0;
    t.direction_deg = {};
    t.frustum_deg = {};
  }
  return wall;
}

// Offset of the right eye's pictures from those of the left eye in the frame [px].
struct SecondPart {
  int dx = 0, dy = 0;
};

SecondPart addSecondPart(StereoMode mode, tiles::TilesSettings& wall) {
  int left = wall.frame_width, right = 0, top = wall.frame_height, bottom = 0;
  for (const tiles::TileSettings& t : wall.tiles) {
    if (!t.followsWall()) continue;
    left = std::min(left, t.x);
    right = std::max(right, t.x + t.width);
    top = std::min(top, t.y);
    bottom = std::max(bottom, t.y + t.height);
  }
  const int width = wall.frame_width + right - left, height = wall.frame_height + bottom - top;
  const bool beside = mode == StereoMode::kSideBySide ||
                      (mode != StereoMode::kTopBottom &&
                       std::max(width, wall.frame_height) <= std::max(wall.frame_width, height));
  const SecondPart part =
      beside ? SecondPart{wall.frame_width - left, 0} : SecondPart{0, wall.frame_height - top};
  (beside ? wall.frame_width : wall.frame_height) = beside ? width : height;
  return part;
}

tiles::TilesSettings inPairs(const StereoSettings& stereo, tiles::TilesSettings wall) {
  const bool halves =
      (stereo.mode == StereoMode::kSideBySide || stereo.mode == StereoMode::kTopBottom) &&
      stereo.size == EyeSize::kHalf;
  const SecondPart part = halves ? SecondPart{} : addSecondPart(stereo.mode, wall);
  for (const tiles::TileSettings& tile : std::exchange(wall.tiles, {})) {
    if (!tile.followsWall()) {
      wall.tiles.push_back(tile);
      continue;
    }
    tiles::TileSettings left = tile;
    if (halves) (stereo.mode == StereoMode::kSideBySide ? left.width : left.height) /= 2;
    tiles::TileSettings right = left;
    right.x += !halves ? part.dx : stereo.mode == StereoMode::kSideBySide ? left.width : 0;
    right.y += !halves ? part.dy : stereo.mode == StereoMode::kTopBottom ? left.height : 0;
    left.eye = tiles::Eye::kLeft;
    right.eye = tiles::Eye::kRight;
    for (tiles::TileSettings* const t : {&left, &right}) {
      t->name = nameFor(t->eye, tile.name);
      wall.tiles.push_back(*t);
    }
  }
  return wall;
}

// Returns the tiles that an output shows for one configured tile, which may have become two.
std::vector<out::PlacedTile> shown(const StereoSettings& stereo, const out::PlacedTile& placed,
                                   const tiles::TilesSettings& pairs) {
  const auto left = std::ranges::find(pairs.tiles, nameFor(tiles::Eye::kLeft, placed.tile),
                                      &tiles::TileSettings::name);
  if (left == pairs.tiles.end() || left->eye != tiles::Eye::kLeft) return {placed};
  out::PlacedTile first = placed, second = placed;
  first.tile = left->name;
  second.tile = nameFor(tiles::Eye::kRight, placed.tile);
  switch (stereo.mode) {
    case StereoMode::kSideBySide: second.x += left->width; return {first, second};
    case StereoMode::kTopBottom: second.y += left->height; return {first, second};
    case StereoMode::kAnaglyph: first.right_eye = second.tile; return {first};
    case StereoMode::kOff:
    case StereoMode::kTwoOutputs: break;
  }
  return {placed};
}

// Returns whether the output shows an anaglyph of the whole frame, which is one of all its tiles.
bool showsAllTiles(const StereoSettings& stereo, const out::OutputSettings& output) {
  return stereo.mode == StereoMode::kAnaglyph && output.kind != out::OutputKind::kSharedMemory &&
         output.tiles.empty();
}

std::vector<out::PlacedTile> placedOn(const StereoSettings& stereo,
                                      const out::OutputSettings& output,
                                      const tiles::TilesSettings& tiles) {
  if (!showsAllTiles(stereo, output)) return output.tiles;
  std::vector<out::PlacedTile> all;
  for (const tiles::TileSettings& t : tiles.tiles) all.push_back({t.name, t.x, t.y});
  return all;
}

// The places of an output's tiles in its signal, by the eye for which they are drawn.
struct PlacesByEye {
  std::vector<out::Rectangle> left, right;
  bool of_both = false;  // there is a tile for both eyes

  // Returns whether the right eye's tiles are those of the left eye moved by `by`, and the left
  // eye's tiles end where the right eye's half begins.
  bool areHalves(int width, int height, std::array<int, 2> by) const {
    if (left.size() != right.size() || width % 2 != 0 || height % 2 != 0) return false;
    const int right_end = by[0] > 0 ? by[0] : width, bottom_end = by[1] > 0 ? by[1] : height;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const out::Rectangle &l = left[i], &r = right[i];
      if (l.x + l.width > right_end || l.y + l.height > bottom_end) return false;
      if (r != out::Rectangle{l.x + by[0], l.y + by[1], l.width, l.height}) return false;
    }
    return true;
  }
};

PlacesByEye placesByEye(const out::OutputSettings& output, const tiles::TilesSettings& tiles) {
  PlacesByEye places;
  const auto add = [&](const tiles::TileSettings& tile, const out::Rectangle& at) {
    if (tile.eye == tiles::Eye::kLeft) places.left.push_back(at);
    if (tile.eye == tiles::Eye::kRight) places.right.push_back(at);
    places.of_both |= tile.eye == tiles::Eye::kMiddle;
  };
  for (const tiles::TileSettings& tile : tiles.tiles) {
    if (output.tiles.empty()) add(tile, out::placeOf({tile.name, tile.x, tile.y}, tile, tiles));
    for (const out::PlacedTile& placed : output.tiles)
      if (placed.tile == tile.name) add(tile, out::placeOf(placed, tile, tiles));
  }
  return places;
}

}  // namespace

EyeTiles eyeTiles(const StereoSettings& stereo, const tiles::TilesSettings& tiles,
                  const std::vector<out::OutputSettings>& outputs, double wall_distance_m) {
  EyeTiles eyes{tiles, outputs, {}};
  const auto plan = tiles::planTiles(tiles);
  if (plan && (stereo.isOn() || stereo.head.station != 0)) {
    const double distance_m =
        stereo.screen_distance_m > 0 ? stereo.screen_distance_m : wall_distance_m;
    eyes.tiles = withScreens(tiles, *plan, distance_m);
    if (stereo.isOn()) {
      Eigen::Map<Vector3d>(eyes.tiles.eyes_m.data()) =
          stereo.eye_separation_m * eyesDirection(stereo, *plan);
      eyes.tiles = inPairs(stereo, std::move(eyes.tiles));
    }
  }
  for (out::OutputSettings& output : eyes.outputs) {
    const bool all = showsAllTiles(stereo, output);
    const std::vector<out::PlacedTile> placed = placedOn(stereo, output, tiles);
    output.tiles.clear();
    std::vector<std::size_t>& from = eyes.placed_from.emplace_back();
    for (std::size_t i = 0; i < placed.size(); ++i) {
      for (const out::PlacedTile& p : shown(stereo, placed[i], eyes.tiles)) {
        output.tiles.push_back(p);
        from.push_back(all ? kWholeFrame : i);
      }
    }
  }
  return eyes;
}

std::optional<correct::SignalParts> signalParts(const out::OutputSettings& output,
                                                const tiles::TilesSettings& tiles) {
  constexpr correct::SignalParts kOne{1, 1}, kBeside{2, 1}, kBelow{1, 2};
  if (output.kind == out::OutputKind::kSharedMemory) return kOne;  // this kind is never corrected
  const PlacesByEye places = placesByEye(output, tiles);
  const auto size = out::pictureSize(output, tiles);
  if (!size || places.left.empty() || places.right.empty()) return kOne;
  if (places.of_both) return std::nullopt;
  if (places.areHalves(size->width, size->height, {size->width / 2, 0})) return kBeside;
  if (places.areHalves(size->width, size->height, {0, size->height / 2})) return kBelow;
  return std::nullopt;
}

std::string pointerInSettings(const EyeTiles& eyes, const std::string& pointer) {
  // "/OUTPUT/tiles/PLACED..."
  std::size_t output = 0, placed = 0;
  const char* const end = pointer.data() + pointer.size();
  if (pointer.empty()) return pointer;
  const auto [after, error] = std::from_chars(pointer.data() + 1, end, output);
  constexpr std::string_view kTiles = "/tiles/";
  const std::string_view rest(after, static_cast<std::size_t>(end - after));
  if (error != std::errc{} || !rest.starts_with(kTiles) || output >= eyes.placed_from.size())
    return pointer;
  const auto [behind, wrong] = std::from_chars(after + kTiles.size(), end, placed);
  const auto& from = eyes.placed_from[output];
  if (wrong != std::errc{} || placed >= from.size()) return pointer;
  if (from[placed] == kWholeFrame) return fmt::format("/{}", output);
  return fmt::format("/{}{}{}{}", output, kTiles, from[placed], std::string_view(behind, end));
}

}  // namespace merlin::render::stereo
