#include "config/describe_stereo.h"

namespace merlin {
namespace {

void describeHead(render::stereo::HeadSettings& h, SettingsVisitor& v) {
  v.text("tracker", h.tracker,
         "Name of the tracker whose receiver is on the viewer's head. Empty: the first tracker.");
  v.integer("station", h.station, {0, 4},
            "Tracker station on the viewer's head, 1 to 4, which says where the eyes are. Head "
            "tracking also works with mode off. While the station sends no pose, the wall is drawn "
            "for the configured place "
            "of the viewer. 0: the head is not tracked.");
  v.numbers("origin_m", h.origin_m, {-1000, 1000},
            "Place in the room, x, y, z in metres, where the viewer's eyes are when the station "
            "reports the position 0, 0, 0. It is the position of the tracker's transmitter minus "
            "the vector from the eyes to the receiver on the head. Without /wall/room it is "
            "relative to the eye for which the tiles are set.");
  v.numbers("axes", h.axes, {-3, 3},
            "Axes of the tracker that correspond to the room's x (right), y (up) and z (towards "
            "the person): 1 is x, 2 is y, 3 is z; a negative number reverses the axis.");
  v.number("scale", h.scale, {0.01, 100},
           "Factor that the positions reported by the station are multiplied by; 1: they are true "
           "metres.");
  v.number("dead_band_m", h.dead_band_m, {0, 1},
           "Distance in metres that a head at rest must move until that counts as motion. It must "
           "be larger than the tracker's noise, so that the picture becomes finer when the viewer "
           "stands still.");
  v.number("dead_band_deg", h.dead_band_deg, {0, 180},
           "Angle in degrees by which the line through the eyes of a head at rest must turn until "
           "that counts as motion.");
}

}  // namespace

void describeStereo(render::stereo::StereoSettings& s, bool from_room, SettingsVisitor& v) {
  v.oneOf("mode", s.mode, render::stereo::kStereoModeNames,
          "How the wall shows a picture to each of the viewer's eyes. Each tile NAME that follows "
          "the wall becomes two, NAME.L and NAME.R, and an output that shows tile NAME shows "
          "both: side_by_side, the left eye's picture on the left; top_bottom, the left eye's "
          "picture above; anaglyph, one picture for glasses with red on the left eye and cyan on "
          "the right one; two_outputs, one output shows NAME.L and another one NAME.R. off: one "
          "picture for both eyes.");
  v.oneOf(
      "size", s.size, render::stereo::kEyeSizeNames,
      "Size of each eye's picture in the modes side_by_side and top_bottom. half: half of the "
      "tile's width or height, so that both together are as large as the tile, as most 3D "
      "projectors expect. full: as large as the tile. An output without tiles is sent the whole "
      "frame: with half, the pair of pictures of each tile is in the place of that tile, as "
      "several projectors on one signal need it; with full, the left eye's pictures of all tiles "
      "come first, then the right eye's, as one 3D display that shows several tiles needs it.");
  v.number("eye_separation_m", s.eye_separation_m,
           {0, 10, "it is in metres, people's are 0.05 to 0.075"},
           "Distance between the viewer's eyes in metres, usually 0.05 to 0.075. 0: both eyes see "
           "the same picture, without depth.");
  if (from_room) {
    v.excluded("screen_distance_m",
               "is given together with /wall/room, which says how far away each screen is: leave "
               "out one of the two");
  } else {
    v.number("screen_distance_m", s.screen_distance_m,
             {0, 1000, "it is in metres, usually 1 to 10; 0 is /wall/scene/wall_distance_m"},
             "Distance from the eye to the screen of each tile that has no screen_m, in metres: "
             "objects at this distance appear in the plane of the screen. 0: the distance "
             "/wall/scene/wall_distance_m.");
  }
  v.numbers("eyes_direction", s.eyes_direction, {-1000, 1000},
            "Direction from the left to the right eye of a viewer whose head is not tracked: x "
            "(right), y (up), z (towards the person), of any length. All 0: along the tile in the "
            "middle of the wall.");
  v.group("head", "Tracking of the viewer's head, for which the wall is drawn.",
          [&] { describeHead(s.head, v); });
}

void describeView(render::tiles::TileCamera& view, render::tiles::FreeCamera& camera,
                  SettingsVisitor& v) {
  v.oneOf("view", view, render::tiles::kTileCameraNames,
          "Whose view is shown. wall: a part of the wall's view, as seen from the viewer's eye. "
          "top, side, front: the whole model from above, from the right, or from where the viewer "
          "stands, in parallel projection; the model is always in the middle and fits. free: the "
          "view of a camera of its own.");
  v.group("camera",
          "The camera that is used if \"view\" is \"free\". Positions are relative to the midpoint "
          "between the viewer's eyes (x right, y up, z towards the person), in metres.",
          [&] {
            v.numbers("eye_m", camera.eye_m, {-1000, 1000},
                      "Position of the camera relative to the midpoint between the viewer's eyes: "
                      "x, y, z in metres.");
            v.numbers("look_at_m", camera.look_at_m, {-1000, 1000},
                      "Point that is in the middle of the camera's picture, relative to the "
                      "midpoint between the viewer's eyes: x, y, z in metres.");
            v.numbers("up", camera.up, {-1000, 1000},
                      "Direction that is upwards in the camera's picture: x, y, z, of any length.");
            v.number("field_of_view_deg", camera.field_of_view_deg, {1, 179},
                     "The camera's horizontal field of view in degrees.");
          });
}

}  // namespace merlin
