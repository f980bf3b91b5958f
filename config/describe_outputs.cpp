#include "config/describe_outputs.h"

namespace merlin {
namespace {

void describeMesh(render::correct::MeshSettings& m, SettingsVisitor& v) {
  v.integer("columns", m.columns, {0, render::correct::kMostMeshSide},
            "Number of points in each row of the grid, at least 2; 0: no mesh.");
  v.integer("rows", m.rows, {0, render::correct::kMostMeshSide},
            "Number of rows of points in the grid, at least 2; 0: no mesh.");
  v.oneOf("interpolation", m.interpolation, render::correct::kMeshInterpolationNames,
          "How the picture is interpolated between the points: bicubic (smoothly, for curved "
          "screens) or bilinear (in each cell on its own, for screens with creases).");
  v.listOf<render::correct::MeshPoint>(
      "points", m.points,
      "Positions on the output of the grid's columns * rows points, row by row from the top. "
      "In the picture before the warp the points are evenly spaced, and the outermost ones lie on "
      "its border.",
      [&](render::correct::MeshPoint& p) {
        const Range range{render::correct::kLeastMeshPlace, render::correct::kMostMeshPlace};
        v.number("x", p.x, range,
                 "Distance of the point from the output's left border, as a share of the output's "
                 "width.");
        v.number("y", p.y, range,
                 "Distance of the point from the output's top border, as a share of the output's "
                 "height.");
      });
}

void describeCorrection(render::correct::CorrectionSettings& c, SettingsVisitor& v) {
  v.numbers("corners", c.corners,
            {-render::correct::kMostCornerOffset, render::correct::kMostCornerOffset},
            "Corner pin: how far the picture's upper left, upper right, lower left and lower right "
            "corner are moved from the output's corners, in pixels. Each corner has two numbers: x "
            "(to the right), then y (down). The corner pin is applied after mesh or mpcdi.");
  v.group("mesh", "Warp by a grid of points, each of which is moved on its own.",
          [&] { describeMesh(c.mesh, v); });
  v.path(
      "mpcdi", c.mpcdi,
      "MPCDI file (profile 2d) with a measured warp and blend, which take the place of mesh, of "
      "the strips of blend and of black: those must not be set as well. Empty: no file is used.");
  v.text(
      "mpcdi_region", c.mpcdi_region,
      "Region of the MPCDI file that belongs to this output. Empty: the only region of the file.");
  v.group(
      "blend",
      "Edge blending: strips of the picture that a neighbour shows as well. The "
      "light decreases towards the border, so that both strips together are as bright as the rest "
      "of the picture.",
      [&] {
        const Range pixels{0, render::correct::kMostCornerOffset};
        v.flag("automatic", c.blend.automatic,
               "Whether left, right, top and bottom are computed: as the widths of the strips that "
               "other tiles on the same screen show as well, which follow from /wall/room or from "
               "screen_m of the tiles. Only for an output that shows a single tile.");
        v.number("left", c.blend.left, pixels,
                 "Width of the strip at the left border that a neighbour shows as well and that is "
                 "blended, in pixels of the picture before the warp; 0: no strip.");
        v.number("right", c.blend.right, pixels,
                 "Width of the strip at the right border that a neighbour shows as well and that "
                 "is blended, in pixels of the picture before the warp; 0: no strip.");
        v.number("top", c.blend.top, pixels,
                 "Height of the strip at the top border that a neighbour shows as well and that is "
                 "blended, in pixels of the picture before the warp; 0: no strip.");
        v.number("bottom", c.blend.bottom, pixels,
                 "Height of the strip at the bottom border that a neighbour shows as well and that "
                 "is blended, in pixels of the picture before the warp; 0: no strip.");
        v.number(
            "gamma", c.blend.gamma, {render::correct::kLeastGamma, render::correct::kMostGamma},
            "Gamma of the projector or display: light = signal ^ gamma. Blend, colour and black "
            "level are computed in linear light.");
      });
  v.group("colour", "Correction of colours, in linear light.", [&] {
    const Range range{-render::correct::kMostColour, render::correct::kMostColour};
    v.numbers(
        "matrix", c.colour.matrix, range,
        "Matrix that the linear light is multiplied by, as nine numbers, row by row: the rows are "
        "the output's red, green and blue, the columns the picture's red, green and blue.");
    v.numbers(
        "gain", c.colour.gain, {0, render::correct::kMostColour},
        "Three factors on the linear light of red, green and blue, applied after the matrix.");
    v.numbers("gamma", c.colour.gamma,
              {render::correct::kLeastChannelGamma, render::correct::kMostChannelGamma},
              "Gamma of the output's red, green and blue, as three factors on the gamma of blend. "
              "Above 1 the middle tones of the channel become brighter.");
  });
  v.group("black",
          "Raises black outside the blend strips to the level of the overlaps, where the black "
          "levels of the projectors add up.",
          [&] {
            v.numbers(
                "level", c.black.level, {0, render::correct::kMostBlack},
                "Linear light of red, green and blue that is added outside the blend strips, as a "
                "share of full brightness.");
          });
}

void describeWindow(render::out::WindowSettings& w, SettingsVisitor& v) {
  v.text("title", w.title, "Title of the window.");
  v.integer("monitor", w.monitor, {0, 15},
            "Number of the monitor on which the window opens, counted from 0 by the desktop.");
  v.integer(
      "x", w.x, {-1, 32767},
      "Column of the window's upper left corner on the monitor, in pixels; -1: in the middle.");
  v.integer(
      "y", w.y, {-1, 32767},
      "Row of the window's upper left corner on the monitor, in pixels, counted from the top; "
      "-1: in the middle.");
  v.integer("width", w.width, {0, 16384},
            "Width of the window when it opens, in pixels; 0: the width of the output's picture.");
  v.integer(
      "height", w.height, {0, 16384},
      "Height of the window when it opens, in pixels; 0: the height of the output's picture.");
  v.flag(
      "fullscreen", w.fullscreen,
      "Whether the window covers its monitor when it opens. The key F11 switches this on and off.");
  v.flag("border", w.border, "Whether the desktop draws a frame and a title around the window.");
  v.oneOf("scale", w.scale, render::out::kWindowScaleNames,
          "How the picture is shown in a window of another size. fit: scaled to the largest size "
          "that fits, with black bars; none: at its own size, in the middle of the window.");
  v.oneOf("on_close", w.on_close, render::out::kOnCloseNames,
          "What happens when a person closes the window. health: only this output stops, and its "
          "health says so; the window opens again when merlind is restarted. stop: merlind ends.");
  v.flag("input", w.input,
         "Whether mouse and keys in the window act on the wall; render/out/window/README.md lists "
         "what they do.");
}

void describeKms(render::out::kms::KmsSettings& k, SettingsVisitor& v) {
  v.text("card", k.card,
         "Device file of the graphics card, for example /dev/dri/card0. Empty: the first card that "
         "has connectors. All displays of one card show a new picture in the same frame.");
  v.text("connector", k.connector,
         "Name of the connector that the display is plugged in at, as in /sys/class/drm, for "
         "example HDMI-A-1. Empty: the first connector that has a display; only for a single "
         "output on its card. *: every connector of the card that has a display and that no other "
         "output names; it is then no fault if there is no such connector, or no card.");
  v.text("mode", k.mode,
         "Mode of the display, WIDTHxHEIGHT or WIDTHxHEIGHT@HZ, for example 1920x1080@60. Empty: "
         "the mode with the size of the picture if the display has one, otherwise the mode that "
         "the display prefers. A smaller picture is shown in the middle, surrounded by black.");
}

}  // namespace

void describeOutputs(std::vector<render::out::OutputSettings>& outputs, SettingsVisitor& v) {
  v.listOf<render::out::OutputSettings>(
      "outputs", outputs,
      "Outputs that receive every frame. If one fails, the others are not affected.",
      [&](render::out::OutputSettings& o) {
        v.oneOf("kind", o.kind, render::out::kOutputKindNames,
                "Kind of the output: shared_memory, for the command `merlin snapshot` and other "
                "programs on this machine (at most one output of this kind); png, a PNG file that "
                "always holds a recent frame; window, a window on a desktop; or kms, a display of "
                "a graphics card, without a desktop.");
        v.text("name", o.name,
               "Name of the output in the status and in events. Empty: the name of its kind.");
        v.path("path", o.path, "Name of the PNG file of an output of kind png.");
        v.number("interval_s", o.interval_s, {1, 86400},
                 "Minimum time between two writes of the PNG file of an output of kind png, in "
                 "seconds.");
        v.number("check_s", o.check_s, {0, 3600},
                 "Time between two checks of what an output of kind shared_memory or kms really "
                 "shows, in seconds. What it shows is read back and compared with what was sent; "
                 "if it is black, frozen or the picture of another program, an event of kind "
                 "picture reports it. 0: never checked.");
        v.group("window", "The window of an output of kind window.",
                [&] { describeWindow(o.window, v); });
        v.group("kms", "The display of an output of kind kms.", [&] { describeKms(o.kms, v); });
        v.listOf<render::out::PlacedTile>(
            "tiles", o.tiles,
            "Tiles that this output shows, and their positions. Empty: the whole frame.",
            [&](render::out::PlacedTile& p) {
              v.text("tile", p.tile,
                     "Name of the tile, as in /wall/tiles/tiles, or of the display in "
                     "/wall/room.");
              v.integer("x", p.x, {0, 32768},
                        "Column of the tile's upper left corner on the output, in pixels.");
              v.integer("y", p.y, {0, 32768},
                        "Row of the tile's upper left corner on the output, in pixels, counted "
                        "from the top.");
              v.oneOf(
                  "mirror", p.mirror, render::out::kMirrorNames,
                  "Whether the tile is mirrored, for rear projection: horizontal exchanges left "
                  "and right, vertical exchanges top and bottom.");
              v.oneOf("turn_deg", p.turn, render::out::kTurnNames,
                      "Clockwise rotation of the tile after mirroring, in degrees, written in "
                      "quotes, such as \"180\": for a projector or display that is mounted on its "
                      "side or upside down.");
            });
        v.group("correction",
                "What is done to the picture so that it looks as meant on this output's screen: "
                "warp, blend, colour, black level. Not for kind shared_memory.",
                [&] { describeCorrection(o.correction, v); });
      });
}

}  // namespace merlin
