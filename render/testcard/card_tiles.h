// What test cards say of a wall's tiles: the outputs that show each, its strips of overlap, and
// which of its corners is a corner of an output's picture. Pure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/out/settings.h"
#include "render/testcard/card.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::testcard {

// `panels`: for the names of tiles the panels that they are on, as far as the wall has any. An
// output of kind shared_memory, which nobody looks at, is not named.
std::vector<CardTile> cardTiles(const tiles::TilePlan& plan,
                                const std::vector<out::OutputSettings>& outputs,
                                const std::map<std::string, std::string>& panels);

// The tile, and its corner, that is seen in a corner (2 * row + column) of an output's picture;
// nothing where no tile is.
std::optional<MarkedCorner> cornerOf(const tiles::TilePlan& plan, const out::OutputSettings& output,
                                     std::size_t corner);

}  // namespace merlin::render::testcard
