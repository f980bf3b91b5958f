#include "config/describe_wall.h"

#include "config/describe_outputs.h"
#include "config/describe_playlist.h"
#include "config/describe_room.h"
#include "config/describe_scene.h"
#include "config/describe_shown.h"
#include "config/describe_stereo.h"
#include "config/describe_tiles.h"

namespace merlin {
namespace {

void describeInput(InputSettings& in, SettingsVisitor& v) {
  v.group(
      "input", "Another machine whose devices this wall uses instead of this machine's devices.",
      [&] {
        v.text(
            "endpoint", in.endpoint,
            "Address of the merlind that reads the devices, tcp://HOST:PORT. Empty: the wall uses "
            "the devices of this machine.");
        v.text("server_key", in.server_key, "Public key of the merlind at `endpoint`.");
        v.secretFile("keys", in.keys,
                     "File with this machine's key pair, written by `merlin keys -o FILE`.");
      });
}

void describeContents(std::vector<ContentSettings>& contents, SettingsVisitor& v) {
  v.listOf<ContentSettings>(
      "contents", contents,
      "Further contents, which the command next_content shows in turn. "
      "Each names a model, a picture or a folder of slides.",
      [&](ContentSettings& c) {
        v.text("name", c.name,
               "Name of the content, for `merlin show`; empty: the name of "
               "its file without the ending.");
        v.path("model", c.model, "Multiresolution model that is this content, an .mrm file.");
        v.path("picture", c.picture,
               "Picture or panorama that is this content: a pyramid (.tif), which `merlin image "
               "import` makes.");
        v.path("slides", c.slides,
               "Folder of slides, which are pyramids (.tif); next_content shows them one after "
               "another, in the order of their names.");
        v.oneOf("show_as", c.show_as, render::content::kShowAsNames,
                "How the picture or the slides are shown: as a plane or as a panorama. marked: a "
                "panorama if it was imported with --panorama, otherwise a plane.");
      });
}

void describeRate(render::governor::GovernorSettings& governor, SettingsVisitor& v) {
  v.group(
      "rate",
      "The frame rate, and limits of the number of triangles, which is adapted to keep the rate.",
      [&] {
        v.number("rate_hz", governor.rate_hz, {1, 240}, "Frames per second while anything moves.");
        v.number("min_rate_hz", governor.min_rate_hz, {1, 240},
                 "Lowest frame rate to which the wall goes down while not even the coarsest detail "
                 "is drawn in time. A rate of less than twice this one is never lowered.");
        v.integer("min_triangles", governor.min_triangles, {4, 1e6},
                  "Minimum number of triangles of a model per frame while anything moves, even if "
                  "frames are late.");
        v.integer("max_triangles", governor.max_triangles, {4, 1e9},
                  "Maximum number of triangles per frame while anything moves.");
        v.integer("first_triangles", governor.first_triangles, {4, 1e9},
                  "Number of triangles per frame until the first frame time has been measured.");
        v.number("late_share", governor.late_share, {0.0001, 0.5},
                 "Share of frames that may be late in the long run; the time that is kept in "
                 "reserve in each frame is adapted to it.");
      });
}

void describeOperator(render::text::OperatorSettings& tile, SettingsVisitor& v) {
  v.group("operator", "What is drawn over the picture on tiles of kind operator.", [&] {
    v.flag("overlay", tile.overlay,
           "Whether rate, frame times, detail, content, posture, devices and messages are drawn "
           "over the picture. A tile of less than 320 x 240 pixels has no room for them.");
    v.flag("panel", tile.panel,
           "Whether the operator's tile (the first one of at least 320 x 240 pixels) has a panel "
           "with buttons for kind of content, content, pan, tilt, zoom, rate, detail, projectors "
           "and lamp. The panel is operated with a mouse or a finger in a window, from a VNC "
           "client or, after the action operator_panel, with the ball.");
  });
}

}  // namespace

void describeWall(WallSettings& w, SettingsVisitor& v) {
  describeInput(w.input, v);
  v.path("model", w.model,
         "Multiresolution model that is shown first, an .mrm file. Empty: the first entry of "
         "contents is shown first.");
  describeContents(w.contents, v);
  v.group("playlist",
          "What the wall shows after a time without input: the contents of the playlist in turn. "
          "The first input ends the playlist; the content that is shown at that moment stays, at "
          "full brightness.",
          [&] { describePlaylist(w.playlist, v); });
  v.group("shown", "Files that `merlin show FILE` shows.", [&] { describeShown(w.shown, v); });
  describeRate(w.governor, v);
  v.group("room",
          "The wall as it is built, from which its tiles are computed: panels, the displays or "
          "projectors on them, and the viewer's place. Axes of the room: x right, y up, z towards "
          "the person who looks at the wall; its origin is any point. `merlin wall plan` draws it.",
          [&] { describeRoom(w.room, v); });
  v.group("tiles", "The geometry of the wall.",
          [&] { describeTiles(w.tiles, w.room.isGiven(), v); });
  v.group("stereo", "Pictures for the viewer's two eyes, and tracking of the viewer's head.",
          [&] { describeStereo(w.stereo, w.room.isGiven(), v); });
  v.group("scene", "Initial view of the model, and how a person's input moves it.",
          [&] { describeScene(w.scene, v); });
  v.group("render", "How the model is drawn.", [&] { describeRender(w.render, v); });
  describeOperator(w.operator_tile, v);
  v.path("snapshots", w.snapshots,
         "Folder for the frames that the action snapshot writes. Empty: snapshots are off.");
  v.integer("snapshots_kept", w.snapshots_kept, {1, 1e6},
            "Number of snapshots kept in the folder; the oldest are removed.");
  describeOutputs(w.outputs, v);
}

}  // namespace merlin
