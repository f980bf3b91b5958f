// Computes what test cards show of a wall's tiles: the outputs that show each tile, its strips of
// overlap, and which of its corners is a corner of an output's picture. Pure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/out/settings.h"
#include "render/testcard/card.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::testcard {

// Returns one entry per tile of the plan. `panels`: maps the names of tiles to those of the panels
// that they are on, if the wall has any. Outputs of kind shared_memory are not named, since nobody
// looks at them.
std::vector<CardTile> cardTiles(const tiles::TilePlan& plan,
                                const std::vector<out::OutputSettings>& outputs,
                                const std::map<std::string, std::string>& panels);

// Returns which tile, and which of its corners, is in a corner (2 * row + column) of an output's
// picture; nothing if no tile is there.
std::optional<MarkedCorner> cornerOf(const tiles::TilePlan& plan, const out::OutputSettings& output,
                                     std::size_t corner);

}  // namespace merlin::render::testcard
