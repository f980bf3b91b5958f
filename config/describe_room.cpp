#include "config/describe_room.h"

#include "config/describe_stereo.h"

namespace merlin {
namespace {

void describePreset(render::room::RoomPresetSettings& p, SettingsVisitor& v) {
  v.oneOf("name", p.name, render::room::kRoomPresetNames,
          "Shape of the wall. none: the room has panels and displays of its own. flat: a row of "
          "panels in one plane. three_160, three_120: three panels, hinged at 160 or 120 degrees. "
          "six: two rows of three frames. hexagon: six panels, closed around the viewer. arc_160: "
          "three panels that fill 160 degrees of the viewer's horizontal view. arc_120: six panels "
          "that fill 120 degrees of it.");
  v.integer("panels", p.panels, {0, render::room::kMostPanels},
            "Number of panels of preset flat; 0: three panels. Other presets have a fixed number.");
  v.number("panel_width_m", p.panel_width_m, {0.01, 1000}, "Width of each panel in metres.");
  v.number("panel_height_m", p.panel_height_m, {0.01, 1000},
           "Height of each panel in metres; half of the wall is above the room's origin.");
  v.number("distance_m", p.distance_m, {0, 1000},
           "Distance from the room's origin to the middle of the wall, in metres. 0: for presets "
           "with hinged panels, the distance at which all panels are equally far from the viewer; "
           "for flat and six, the width of the wall.");
  v.number("bezel_m", p.bezel_m, {0, 100},
           "Width of the frame of each display in metres; panel_width_m and panel_height_m include "
           "it.");
  v.number("overlap_m", p.overlap_m, {0, 500},
           "Width of the strip that neighbouring projectors of presets flat and six both show, in "
           "metres; it makes their pictures larger, but not the wall. How the strip is blended is "
           "set in each output's correction.");
  v.integer("width", p.width, {0, 8192},
            "Width of each display in pixels; 0: the width /wall/tiles/tile_width.");
  v.integer("height", p.height, {0, 8192},
            "Height of each display in pixels; 0: the height /wall/tiles/tile_height.");
}

void describePanel(render::room::PanelSettings& p, SettingsVisitor& v) {
  v.text("name", p.name, "Name of the panel.");
  v.number("width_m", p.width_m, {0, 1000}, "Width of the panel in metres.");
  v.number("height_m", p.height_m, {0, 1000}, "Height of the panel in metres.");
  v.number("hinge_deg", p.hinge_deg, {0, 350},
           "Angle between this panel and its left neighbour, which is the one before it in the "
           "list, measured on the viewer's side, in degrees; 180: both are in one plane. 0: the "
           "panel is not hinged, and lower_left_m, yaw_deg and pitch_deg give its place.");
  v.numbers("lower_left_m", p.lower_left_m, {-1000, 1000},
            "Position of the panel's lower left corner, as the viewer sees it, in the room: x, y, "
            "z in metres. Only for a panel that is not hinged.");
  v.number("yaw_deg", p.yaw_deg, {-360, 360},
           "Direction in which a viewer who stands in front of the panel looks at it, as an angle "
           "to the left of straight ahead, in degrees. Only for a panel that is not hinged.");
  v.number("pitch_deg", p.pitch_deg, {-360, 360},
           "Direction in which a viewer who stands in front of the panel looks at it, as an angle "
           "upwards that is applied after the yaw, in degrees; -90: the panel is the floor. Only "
           "for a panel that is not hinged.");
}

void describeDisplay(render::room::DisplaySettings& d, SettingsVisitor& v) {
  v.text("name", d.name, "Name of the display and of its tile.");
  v.text("panel", d.panel,
         "Name of the panel on which this display shows its picture. Empty: the only panel of the "
         "room.");
  v.numbers("part_m", d.part_m, {-1000, 1000},
            "Part of the panel that the display covers: distance of its left edge from the panel's "
            "left edge, distance of its lower edge from the panel's lower edge, width and height, "
            "in metres. Parts may overlap. All 0: the whole panel.");
  v.integer("width", d.width, {0, 8192},
            "Width of the display's picture in pixels; 0: the width /wall/tiles/tile_width.");
  v.integer("height", d.height, {0, 8192},
            "Height of the display's picture in pixels; 0: the height /wall/tiles/tile_height.");
  v.numbers("bezel_m", d.bezel_m, {0, 100},
            "Width of the display's frame on the left, right, lower and upper side, in metres. The "
            "part of the panel that the display covers includes the frame; what is behind the "
            "frame is not drawn.");
  describeView(d.view, d.camera, v);
}

}  // namespace

void describeRoom(render::room::RoomSettings& r, SettingsVisitor& v) {
  v.group("preset", "A common shape of a wall, chosen by its name, instead of panels and displays.",
          [&] { describePreset(r.preset, v); });
  v.listOf<render::room::PanelSettings>(
      "panels", r.panels, "Panels of the wall, from left to right.",
      [&](render::room::PanelSettings& p) { describePanel(p, v); });
  v.listOf<render::room::DisplaySettings>(
      "displays", r.displays,
      "Displays or projectors; each becomes a tile. Empty: each panel has one display, with the "
      "name of the panel.",
      [&](render::room::DisplaySettings& d) { describeDisplay(d, v); });
  v.numbers("eye_m", r.eye_m, {-1000, 1000},
            "Position of the viewer's eye in the room: x, y, z in metres.");
  v.integer("operator_width", r.operator_width, {0, 8192},
            "Width of the operator's tile, which is named operator, in pixels. If width and height "
            "are 0, there is no operator's tile.");
  v.integer("operator_height", r.operator_height, {0, 8192},
            "Height of the operator's tile in pixels. If width and height are 0, there is no "
            "operator's tile.");
}

}  // namespace merlin
