// Common walls by name, as panels and displays. Pure.
//
//   flat       a row of panels in one plane; the viewer's distance is the row's width
//   three_160  three panels, hinged at 160 degrees; the viewer is equally far from all
//   three_120  three panels, hinged at 120 degrees; the viewer is equally far from all
//   six        two rows of three panels in one plane; the viewer's distance is their width
//   hexagon    six panels, hinged at 120 degrees, closed around the viewer in the middle
//   arc_160    three panels that fill 160 degrees of the view; the viewer is equally far from all
//   arc_120    six panels that fill 120 degrees of the view; the viewer is equally far from all
#pragma once

#include "render/room/settings.h"

namespace merlin::render::room {

// Returns the room with explicit panels and displays: the panels of its preset, and one display per
// panel if the room has no displays. If overlap_m is set, the panels become one panel as large as
// all of them together. Half of a preset's height is above the room's origin and half below.
RoomSettings withPanels(const RoomSettings& room);

// Returns the number of the preset's panels; 0 for RoomPreset::kNone.
std::size_t panelCount(const RoomPresetSettings& preset);

}  // namespace merlin::render::room
