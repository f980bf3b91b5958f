// Computes the tiles of a wall in stereo, and which of them its outputs show. Pure.
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
  // By output, and by placed tile of `outputs`: index of the placed tile in the settings from which
  // it was made.
  std::vector<std::vector<std::size_t>> placed_from;
};

// Returns the wall's tiles and outputs as they are drawn. Without stereo and without a head
// station, tiles and outputs are unchanged. With either, each tile that follows the wall has a
// screen: its own, or one across its direction at the distance that the settings say, which its
// frustum fills.
//
// Places of the pictures in the frame: two pictures of half size are in the place of their tile.
// Otherwise the left eye's picture is where the tile was, and the right one's in a second part of
// the frame, to the right (side_by_side), below (top_bottom), or where the frame's longer side
// becomes shorter. Snapshots of the wall's picture show the left eye's. REQUIRES: the tiles'
// validate() found nothing. Settings that cannot be shown are reported by validate(), not here.
EyeTiles eyeTiles(const StereoSettings& stereo, const tiles::TilesSettings& tiles,
                  const std::vector<out::OutputSettings>& outputs, double wall_distance_m);

// Returns how the output's signal is divided into pictures: two if the halves of the signal are the
// left and the right eye's pictures, with the same arrangement, else one. Nothing if the pictures
// of both eyes are arranged otherwise, for which there is no correction. `output` and `tiles` are
// those of EyeTiles.
std::optional<correct::SignalParts> signalParts(const out::OutputSettings& output,
                                                const tiles::TilesSettings& tiles);

// Translates `pointer`, of a fault that validate() finds in EyeTiles::outputs, to the settings from
// which these outputs were made.
std::string pointerInSettings(const EyeTiles& eyes, const std::string& pointer);

}  // namespace merlin::render::stereo
