// The tiles of a wall in stereo, and what its outputs show of them. Pure.
//
// Each tile that follows the wall becomes two, NAME.L and NAME.R, which show the same screen from
// the left and the right eye. An output that shows tile NAME shows what the mode makes of the two:
// both packed beside or below each other, or both in one anaglyph; it may also name one of them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "render/out/settings.h"
#include "render/stereo/settings.h"
#include "render/tiles/settings.h"

namespace merlin::render::stereo {

struct EyeTiles {
  tiles::TilesSettings tiles;
  std::vector<out::OutputSettings> outputs;
  // By output and placed tile of `outputs`: number of the placed tile in the settings that it
  // stands for.
  std::vector<std::vector<std::size_t>> placed_from;
};

// The wall as it is drawn. Without stereo and without a head station, tiles and outputs are what
// they were. With either, each tile that follows the wall has a screen: its own, or one across its
// direction at the distance that the settings say, which its frustum fills.
//
// Where the pictures are in the frame: halves, in the place of their tile. Otherwise the left eye's
// picture is where the tile was, and the right one's in a second part of the frame, to the right
// (side_by_side), below (top_bottom), or where the frame's longer side becomes shorter. Snapshots
// of the wall's picture show the left eye's. REQUIRES: the tiles' validate() found nothing. What
// cannot be shown is left for validate().
EyeTiles eyeTiles(const StereoSettings& stereo, const tiles::TilesSettings& tiles,
                  const std::vector<out::OutputSettings>& outputs, double wall_distance_m);

// The parts of the output's signal that have a picture each: two if the halves of the signal are
// the left and the right eye's, with the same arrangement. Nothing if the pictures of both eyes are
// in other places: no correction fits them. Output and tiles as in EyeTiles.
std::optional<correct::SignalParts> signalParts(const out::OutputSettings& output,
                                                const tiles::TilesSettings& tiles);

// Pointer of a fault of EyeTiles::outputs, as their validate() gives it, in the settings that the
// outputs were made from.
std::string pointerInSettings(const EyeTiles& eyes, const std::string& pointer);

}  // namespace merlin::render::stereo
