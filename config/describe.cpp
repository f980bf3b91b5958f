// The only description of every setting: its key, range and meaning. The loader, the schema and
// `merlind --print-config` are generated from it.
#include <fmt/format.h>

#include "config/settings.h"
#include "config/visitor.h"
#include "daemon/base/commands.h"

namespace merlin {
namespace {

constexpr const char* kSlot7Rules[] = {"zero", "neutral", "derived", "switch"};
constexpr const char* kBackends[] = {"egl", "osmesa"};
constexpr const char* kTileKinds[] = {"wall", "operator"};
constexpr const char* kWhen[] = {"by_action", "enter", "hold", "leave"};
constexpr const char* kScripts[] = {"visit", "turning", "still", "grabbing", "alignment", "pushes"};

constexpr const char* kDialogues[] = {"binary", "text"};
constexpr const char* kWristLights[] = {"switch", "off", "on"};
constexpr const char* kTrackerNumbers[] = {"binary", "text", "short"};
constexpr const char* kGloves[] = {"cyberglove"};
constexpr const char* kTrackers[] = {"fastrak"};
constexpr const char* kBalls[] = {"spaceball", "sample"};

void describeLine(LineSettings& line, std::span<const char* const> drivers, SettingsVisitor& v) {
  v.choiceOf("driver", line.driver, drivers, "Driver that speaks to the device.");
  v.text(
      "port", line.port,
      "Where the device is connected: serial:/dev/... (preferably a name under /dev/serial/by-id), "
      "pty:PATH, tcp://HOST:PORT (a raw serial server) or replay:FILE. Empty: no device.");
  static const std::string kBaud = fmt::format("Speed of the serial line in bits per second: {}.",
                                               fmt::join(lineSpeeds(), ", "));
  v.integer("baud", line.baud,
            {static_cast<double>(lineSpeeds().front()), static_cast<double>(lineSpeeds().back())},
            kBaud.c_str());
  v.integer("max_bytes_s", line.max_bytes_s, {0, 100'000'000},
            "Maximum number of bytes per second that are read from the line. A line that sends "
            "more is read at this rate and without real-time priority, and its health reports it. "
            "0: four times what the baud rate carries, or 1000000 for tcp:// and replay:.");
}

void describeGlove(DevicesSettings& d, SettingsVisitor& v) {
  describeLine(d.glove_line, kGloves, v);
  v.numbers("offset", d.glove.offset, {-10000, 10000},
            "Raw sensor value at an angle of 0 rad, for each slot 0 to 22.");
  v.numbers("gain", d.glove.gain, {-1, 1},
            "Angle in radians for one raw count, for each slot 0 to 22; negative for a sensor that "
            "is mounted the other way round.");
  v.oneOf("slot7", d.glove.slot7, kSlot7Rules,
          "Value of slot 7, which no known glove measures. zero: 0; neutral: the middle of the raw "
          "range; derived: the mean of slots 3 and 11, its neighbours; switch: the wrist switch (1 "
          "on, 0 off).");
  v.number("rate_hz", d.glove.rate_hz, {1, 150}, "Records per second that the glove is asked for.");
  v.oneOf("dialogue", d.glove.dialogue, kDialogues,
          "Format of the glove's records and commands: binary, or decimal text, which takes four "
          "times as long on the line.");
  v.oneOf("light", d.glove.light, kWristLights,
          "Light on the glove's wrist. switch: it shows the state of the wrist switch; off or on: "
          "it stays so.");
  v.flag("time_stamps", d.glove.time_stamps,
         "Whether the interface unit adds a time stamp to each record, so that the sample counter "
         "can also count records that were lost.");
  v.flag("filter", d.glove.filter, "Whether the interface unit's own low-pass filter is on.");
}

void describeTrackerForm(FastrakSettings& t, SettingsVisitor& v) {
  constexpr const char* kAlignments[] = {"alignment1_cm", "alignment2_cm", "alignment3_cm",
                                         "alignment4_cm"};
  constexpr const char* kBoresights[] = {"boresight1_wxyz", "boresight2_wxyz", "boresight3_wxyz",
                                         "boresight4_wxyz"};
  for (std::size_t i = 0; i < 4; ++i) {
    v.numbers(kAlignments[i], t.alignment_cm[i], {-1000, 1000},
              "Reference frame of this station, in the transmitter's frame: the new origin, a "
              "point on the new x axis and a point on the new y axis, in centimetres.");
    v.numbers(kBoresights[i], t.boresight_wxyz[i], {-1, 1},
              "Boresight of this station: the orientation that counts as straight ahead, a "
              "quaternion w, x, y, z.");
  }
  v.numbers("position_filter", t.position_filter, {0, 1},
            "The tracker's own filter of positions: sensitivity, low limit, high limit, factor. "
            "Low and high equal to 1 turn it off.");
  v.numbers("angle_filter", t.angle_filter, {0, 1},
            "The tracker's own filter of orientations: sensitivity, low limit, high limit, factor. "
            "Low and high equal to 1 turn it off.");
  v.oneOf("numbers", t.numbers, kTrackerNumbers,
          "Format of numbers on the line: binary floats, decimal text, or 14-bit integers (short; "
          "units made before 2012).");
  v.flag("angles", t.angles,
         "Whether the tracker sends azimuth, elevation and roll instead of a quaternion.");
  v.flag("stylus", t.stylus,
         "Whether station 1 is a stylus; if so, each record has the state of its button.");
  v.numbers("stylus_tip_cm", t.stylus_tip_cm, {-100, 100},
            "Position of the stylus' tip relative to its coil: x, y, z in centimetres.");
}

void describeTracker(DevicesSettings& d, SettingsVisitor& v) {
  describeLine(d.tracker_line, kTrackers, v);
  constexpr const char* kKeys[] = {"hemisphere1", "hemisphere2", "hemisphere3", "hemisphere4"};
  for (std::size_t i = 0; i < d.tracker.hemisphere.size(); ++i) {
    v.numbers(
        kKeys[i], d.tracker.hemisphere[i], {-1, 1},
        "Hemisphere of this station: a vector in the transmitter's frame that points into the half "
        "of space where the receiver is. 0, 0, 0: the tracker follows the receiver.");
  }
  describeTrackerForm(d.tracker, v);
  v.flag("centimetres", d.tracker.centimetres,
         "Unit of positions on the line: true for centimetres, false for inches. Samples are in "
         "metres either way.");
}

void describeBall(DevicesSettings& d, SettingsVisitor& v) {
  describeLine(d.ball_line, kBalls, v);
  v.integer("full_scale_translation", d.ball.full_scale_translation, {100, 32767},
            "Raw counts of a full push.");
  v.integer("full_scale_rotation", d.ball.full_scale_rotation, {100, 32767},
            "Raw counts of a full twist.");
  v.integer("null_region", d.ball.null_region, {0, 63},
            "Size of the ball's own null region: pushes below it count as none.");
  v.flag("cubic", d.ball.cubic,
         "Whether the ball itself amplifies hard pushes more than gentle ones (a cubic response "
         "instead of a linear one).");
  v.flag("rezero", d.ball.rezero,
         "Whether the ball takes its present state as its rest position when it is opened. Nobody "
         "may touch it at that moment.");
  v.text("beep", d.ball.beep,
         "Tune that the ball beeps when it is ready: a lower-case letter is a tone, an upper-case "
         "letter a pause. Empty: no tune.");
  v.integer("dead_zone", d.ball.dead_zone, {0, 99},
            "Raw counts of an axis, in either direction, that are treated as rest.");
  v.numbers("axis_map", d.ball.axis_map, {-6, 6},
            "Device axis (1 to 6) for each of x, y, z and the rotations about x, y, z; a negative "
            "number reverses the axis.");
}

void describeTiles(render::TilesSettings& t, SettingsVisitor& v) {
  v.integer("tile_width", t.tile_width, {16, 8192}, "Width of each tile in pixels.");
  v.integer("tile_height", t.tile_height, {16, 8192}, "Height of each tile in pixels.");
  v.integer("frame_width", t.frame_width, {16, 16384},
            "Width of the frame, which contains all tiles, in pixels.");
  v.integer("frame_height", t.frame_height, {16, 16384},
            "Height of the frame, which contains all tiles, in pixels.");
  v.number("field_of_view_deg", t.field_of_view_deg, {1, 179},
           "Horizontal field of view of one tile, in degrees.");
  v.number("near_m", t.near_m, {0.001, 1000},
           "Distance of the near clipping plane in metres: nothing nearer is drawn.");
  v.number("far_m", t.far_m, {0.01, 1e6},
           "Distance of the far clipping plane in metres: nothing farther is drawn.");
  v.listOf<render::TileSettings>(
      "tiles", t.tiles, "Position of each tile in the frame, and what it shows.",
      [&](render::TileSettings& tile) {
        v.text("name", tile.name, "Name of the tile.");
        v.oneOf("kind", tile.kind, kTileKinds,
                "What the tile shows. wall: its part of the wall's view; operator: the operator's "
                "view of the whole model.");
        v.integer("x", tile.x, {0, 16384},
                  "Column of the tile's upper left corner in the frame, in pixels.");
        v.integer(
            "y", tile.y, {0, 16384},
            "Row of the tile's upper left corner in the frame, in pixels, counted from the top.");
        v.number("turns", tile.turns, {-8, 8},
                 "Rotation of the tile's view about the vertical axis, in units of one tile's "
                 "field of view; +1 is one tile to the left.");
        v.integer("width", tile.width, {0, 8192}, "Width of this tile in pixels; 0: tile_width.");
        v.integer("height", tile.height, {0, 8192},
                  "Height of this tile in pixels; 0: tile_height.");
        v.numbers("direction_deg", tile.direction_deg, {-180, 180},
                  "Direction of the tile's view in addition to turns, in degrees: yaw to the left, "
                  "then pitch upwards, then roll counter-clockwise as the viewer sees it.");
        v.numbers("frustum_deg", tile.frustum_deg, {-89.5, 89.5},
                  "Angles of the left, right, lower and upper edge of the tile from its direction, "
                  "in degrees; left and lower ones are negative. All 0: symmetric, with "
                  "field_of_view_deg. Views of different tiles may overlap.");
        v.numbers("screen_m", tile.screen_m, {-1000, 1000},
                  "Lower left, lower right and upper left corner of the tile's screen as seen from "
                  "the eye (x right, y up, z towards the person), in metres. Direction and frustum "
                  "follow from them. All 0: none.");
      });
}

void describeScene(render::SceneSettings& s, SettingsVisitor& v) {
  v.number("model_radius_m", s.model_radius_m, {0.001, 1000},
           "Radius of the bounding sphere that the model is scaled to, in metres.");
  v.number("model_distance_m", s.model_distance_m, {0, 1000},
           "Initial distance of the model's centre in front of the eye, in metres.");
  v.number("model_yaw_deg", s.model_yaw_deg, {-360, 360},
           "Initial rotation of the model about the vertical axis, in degrees, applied after the "
           "pitch.");
  v.number("model_pitch_deg", s.model_pitch_deg, {-360, 360},
           "Initial rotation of the model about the horizontal axis, in degrees, applied before "
           "the yaw; -90 for a model whose z axis points up.");
  v.numbers("ball_speed_m_s", s.ball_speed_m_s, {-100, 100},
            "Speed of the motion along x, y, z at a full push of the ball, in metres per second.");
  v.numbers(
      "ball_turn_deg_s", s.ball_turn_deg_s, {-3600, 3600},
      "Speed of the rotation about x, y, z at a full twist of the ball, in degrees per second.");
  v.numbers("tracker_axes", s.tracker_axes, {-3, 3},
            "Axes of the tracker that correspond to the wall's x (right), y (up) and z (towards "
            "the person): 1 is x, 2 is y, 3 is z; a negative number reverses the axis.");
  v.number(
      "hand_gain", s.hand_gain, {0.01, 1000},
      "Motion of the model in metres for one metre of motion of the hand, while the hand grabs.");
  v.number("fly_gain", s.fly_gain, {0.01, 1000},
           "Speed of the viewer in metres per second for one metre of motion of the hand, while "
           "the hand flies.");
  v.numbers("tracker_origin_m", s.tracker_origin_m, {-100, 100},
            "Position of the tracker's transmitter relative to the eye, used for pointing: x "
            "right, y up, z towards the person, in metres.");
  v.number(
      "wall_distance_m", s.wall_distance_m, {0.1, 100},
      "Distance from the eye to the wall, used when the hand points past the model, in metres.");
  v.number("hand_noise_m", s.hand_noise_m, {0, 1},
           "Motion of the hand that is treated as noise of the tracker, in metres.");
  v.number("hand_noise_deg", s.hand_noise_deg, {0, 180},
           "Rotation of the hand that is treated as noise of the tracker, in degrees.");
  v.number("still_after_s", s.still_after_s, {0.01, 10},
           "Time without input after which the scene counts as still, in seconds.");
  v.number("return_after_s", s.return_after_s, {0, 86400},
           "Time for which no tile of the wall has shown any part of the content, after which the "
           "initial view returns as soon as nobody moves it, in seconds; 0: never.");
}

void describeRender(render::RenderSettings& r, SettingsVisitor& v) {
  v.oneOf("backend", r.gl.backend, kBackends,
          "OpenGL implementation that draws without a window: egl (uses a GPU where there is one) "
          "or osmesa (software).");
  v.integer("contexts", r.gl.contexts, {0, 2},
            "Number of OpenGL contexts that share the tiles, each on a thread of its own; 2 needs "
            "EGL. 0: two for a software renderer on two cores or more, otherwise one.");
  v.integer("raster_threads", r.gl.raster_threads, {0, 16},
            "Number of rasterizer threads of Mesa's software renderer; 0: the drawing thread "
            "itself rasterizes.");
  v.text("show", r.model.show.feature,
         "Feature of the model that is shown as colours on a scale (thermal, confidence ...). "
         "Empty: the model's own colours. Every content must have this feature.");
  v.numbers("show_range", r.model.show.range, {-1e9, 1e9},
            "First and last value of the colour scale of show. Two equal numbers: the range of the "
            "model's values.");
  v.flag("view_dependent", r.model.view_dependent,
         "Whether triangles are spent where the tiles look, and more densely near the eye. "
         "Otherwise the whole model has a uniform resolution.");
  v.number("geomorph", r.model.geomorph, {0, 0.5},
           "Share of the triangles whose vertices move gradually to where they will merge "
           "(geomorphs), so that changes of detail do not pop. 0: vertices jump.");
  v.integer("fade_frames", r.fade_frames, {1, 30},
            "Number of frames over which a finer image of a still scene replaces a coarser one; 1: "
            "at once.");
  v.numbers(
      "colour", r.model.style.colour, {0, 1},
      "Colour of a model that has no colours of its own: red, green, blue, each from 0 to 1.");
  v.numbers("background", r.model.style.background, {0, 1},
            "Background colour: red, green, blue, each from 0 to 1.");
  v.number("brightness", r.model.style.brightness, {0.1, 10},
           "Factor on the model's colours; above 1 for dark scans.");
  v.flag("draw_back_faces", r.model.style.draw_back_faces,
         "Whether back faces are drawn, for open scans that are seen from behind. Drawing then "
         "takes 1.6 to 1.9 times as long.");
  v.flag("wireframe", r.model.style.wireframe, "Whether edges are drawn instead of faces.");
}

void describeGpio(GpioSettings& g, SettingsVisitor& v) {
  v.text("chip", g.chip,
         "GPIO chip of the control panel: gpiochip0 or /dev/gpiochip0. Empty: there is no panel.");
  v.integer("projector_line", g.projector_line, {-1, 1023},
            "GPIO line that is high while the projectors have power; -1: none.");
  v.integer("video_line", g.video_line, {-1, 1023},
            "GPIO line of the video switch, low for input A and high for input B; -1: none.");
  v.integer("lamp_line", g.lamp_line, {-1, 1023},
            "GPIO line that is high while the status lamp is lit; -1: none.");
  v.integer("button_line", g.button_line, {-1, 1023},
            "GPIO line that is high while the button is pressed; -1: none.");
  v.number(
      "warm_up_s", g.warm_up_s, {0, 3600},
      "Time that the projectors need after switching on before they show an image, in seconds.");
  v.number("cool_down_s", g.cool_down_s, {0, 3600},
           "Time after switching off during which the projectors are not switched on again, in "
           "seconds.");
  v.number("interlock_s", g.interlock_s, {0, 3600},
           "Minimum time between two switching operations of the projectors, in seconds.");
  v.number("debounce_s", g.debounce_s, {0, 1},
           "Minimum time that the button must be pressed before it takes effect, in seconds.");
}

// "What the input does. While it is held: grab (The tracked ...), ... Once: reset_view (...), ..."
std::string actionsHelp() {
  std::string held, once;
  for (const CommandInfo& c : kCommands) {
    if (c.bindable == Bindable::kNo) continue;
    std::string& list = c.bindable == Bindable::kHeld ? held : once;
    list += fmt::format("{}{}: {}", list.empty() ? "" : " ", c.name, c.help);
  }
  return fmt::format("What the input does. As long as it is held: {} Once: {}", held, once);
}

void describeBindings(DevicesSettings& d, SettingsVisitor& v) {
  static const std::string kInput = fmt::format("Name of the input: {}.", kInputForms);
  static const std::string kAction = actionsHelp();
  v.listOf<Binding>(
      "bindings", d.bindings,
      "What each input does. A wall executes the actions that are for walls, also on another "
      "machine; the machine that has the panel executes those of the panel.",
      [&](Binding& b) {
        v.text("input", b.input, kInput.c_str());
        v.choiceOf("action", b.action, kActions, kAction.c_str());
        v.oneOf("on", b.when, kWhen,
                "When the action happens: hold (as long as the input is held), enter or leave "
                "(once, when the input begins or ends). by_action: hold or enter, as the action "
                "requires.");
      });
  v.number("stale_after_s", d.stale_after_s, {0.1, 10},
           "Time after which the input of a device that has stopped working is released, in "
           "seconds.");
}

void describeServe(ServeSettings& s, SettingsVisitor& v) {
  v.path("spnav_socket", s.spnav_socket,
         "Socket on which programs built on libspnav get the Spaceball, usually /run/spnav.sock. "
         "Empty: no such server.");
  v.integer("vrpn_port", s.vrpn_port, {0, 65535},
            "Port on which VRPN clients on this machine get hand, tracker and ball, usually 3883; "
            "0: no such server.");
  v.text("samples_endpoint", s.samples_endpoint,
         "Address on which walls on other machines get samples, encrypted, such as tcp://*:7401. "
         "Empty: no such server.");
  v.path("samples_keys", s.samples_keys,
         "File with this machine's key pair, written by merlin keys -o FILE.");
  v.path("samples_clients", s.samples_clients,
         "File with the public keys of the machines that may receive samples, one per line.");
}

void describeWall(WallSettings& w, SettingsVisitor& v) {
  v.group("input", "Devices of another machine, which replace this machine's.", [&] {
    v.text("endpoint", w.input.endpoint,
           "Address of the merlind that reads the devices, tcp://HOST:PORT. Empty: this machine's "
           "shared memory.");
    v.text("server_key", w.input.server_key, "Public key of the merlind at endpoint.");
    v.path("keys", w.input.keys,
           "File with this machine's key pair, written by merlin keys -o FILE.");
  });
  v.path("model", w.model, "Multiresolution model that is shown first, an .mrm file.");
  v.listOf<ContentSettings>("contents", w.contents,
                            "Further models, which the command next_content shows in turn.",
                            [&](ContentSettings& c) {
                              v.path("model", c.model, "Multiresolution model, an .mrm file.");
                            });
  v.group(
      "rate", "The frame rate, and the limits within which triangles are given up for it.", [&] {
        v.number("rate_hz", w.governor.rate_hz, {1, 240},
                 "Frames per second while anything moves.");
        v.integer(
            "min_triangles", w.governor.min_triangles, {4, 1e6},
            "Minimum number of triangles per frame while anything moves, even if frames are late.");
        v.integer("max_triangles", w.governor.max_triangles, {4, 1e9},
                  "Maximum number of triangles per frame while anything moves.");
        v.integer("first_triangles", w.governor.first_triangles, {4, 1e9},
                  "Number of triangles per frame before any frame time has been measured.");
        v.number("late_share", w.governor.late_share, {0.0001, 0.5},
                 "Share of frames that may be late in the long run; the governor adapts its time "
                 "reserve to it.");
      });
  v.group("tiles", "The geometry of the wall.", [&] { describeTiles(w.tiles, v); });
  v.group("scene", "Initial position of the model, and what a person's input does.",
          [&] { describeScene(w.scene, v); });
  v.group("render", "How the model is drawn.", [&] { describeRender(w.render, v); });
  v.path("snapshots", w.snapshots,
         "Folder for the frames that the action snapshot writes. Empty: snapshots are off.");
  v.integer("snapshots_kept", w.snapshots_kept, {1, 1e6},
            "Number of snapshots kept in the folder; the oldest are removed.");
  v.listOf<render::OutputSettings>(
      "outputs", w.outputs,
      "Outputs that receive every frame. If one fails, the others are not affected.",
      [&](render::OutputSettings& o) {
        v.oneOf("kind", o.kind, render::kOutputKindNames,
                "Kind of the output: shared_memory, for merlin snapshot and other programs on this "
                "machine (at most one), or png, a PNG file that always holds a recent frame.");
        v.text("name", o.name, "Name of the output in status and events. Empty: its kind.");
        v.path("path", o.path, "Name of the PNG file, for kind png.");
        v.number("interval_s", o.interval_s, {1, 86400},
                 "Minimum time between two writes of the file, in seconds, for kind png.");
        v.listOf<render::PlacedTile>(
            "tiles", o.tiles, "Tiles that this output shows, and where. Empty: the whole frame.",
            [&](render::PlacedTile& p) {
              v.text("tile", p.tile, "Name of the tile, as in /wall/tiles/tiles.");
              v.integer("x", p.x, {0, 32768},
                        "Column of the tile's upper left corner on the output, in pixels.");
              v.integer("y", p.y, {0, 32768},
                        "Row of the tile's upper left corner on the output, in pixels, counted "
                        "from the top.");
              v.oneOf(
                  "mirror", p.mirror, render::kMirrorNames,
                  "Whether the tile is mirrored, for rear projection: horizontal exchanges left "
                  "and right, vertical exchanges top and bottom.");
              v.oneOf("turn_deg", p.turn, render::kTurnNames,
                      "Clockwise rotation of the tile after mirroring, in degrees, for a projector "
                      "or display that is mounted on its side or upside down.");
            });
      });
}

}  // namespace

void describe(Settings& s, SettingsVisitor& v) {
  v.text("instance", s.instance,
         "Name of this daemon. It is part of the names of shared memory and sockets and so "
         "distinguishes several daemons on one machine.");
  v.path("run_directory", s.run_directory,
         "Folder for sockets and for the emulators' pseudo-terminals. Empty: /run/merlin for root, "
         "the user's own run directory for others.");
  v.group("devices", "The devices that are read.", [&] {
    v.group("glove", "A CyberGlove.", [&] { describeGlove(s.devices, v); });
    v.group("tracker", "A Polhemus Fastrak.", [&] { describeTracker(s.devices, v); });
    v.group("ball", "A Spaceball.", [&] { describeBall(s.devices, v); });
    v.group("hand", "The hand, which combines glove and tracker.", [&] {
      v.integer(
          "station", s.devices.hand.station, {1, 4},
          "Tracker station that is worn on the hand, 1 to 4; it moves the model while the "
          "hand grabs. A wall that gets its devices from another machine uses its own value.");
      v.number("cutoff_hz", s.devices.hand.cutoff_hz, {0, 100},
               "Cut-off frequency, in Hz, of the low-pass filter on the pose of a hand at rest. It "
               "adds a delay of 1 / (2 pi cut-off). 0: no filter.");
      v.number(
          "cutoff_per_m_s", s.devices.hand.cutoff_per_m_s, {0, 1000},
          "Increase of the cut-off frequency with the hand's speed, in Hz per metre per second.");
    });
    v.group("gpio", "The wall's control panel on a GPIO chip.",
            [&] { describeGpio(s.devices.gpio, v); });
    v.path("postures", s.devices.postures,
           "File of the posture network, JSON. Empty: no posture is recognised.");
    v.number("posture_hold_s", s.devices.posture_hold.hold_s, {0, 10},
             "Minimum time that a posture must be held before it counts as begun, in seconds.");
    v.number("posture_leave_s", s.devices.posture_hold.leave_s, {0, 10},
             "Minimum time that a posture must be absent before it counts as ended, in seconds.");
    v.number("posture_margin", s.devices.posture_hold.least_margin, {0, 1},
             "Minimum margin (0 to 1) of the network's decision for a posture to be recognised; "
             "half of it suffices to keep the current posture.");
    describeBindings(s.devices, v);
    v.integer("cpu_latency_us", s.devices.cpu_latency_us, {-1, 10000},
              "Maximum time that idle CPU cores may take to wake up, for the whole machine, in "
              "microseconds. 0 keeps them from sleeping, which costs power; -1 leaves the system's "
              "setting.");
    v.choiceOf("script", s.devices.script, kScripts,
               "What the emulated person does when merlind runs with --emulate.");
  });
  v.group("wall", "What the wall shows, and how.", [&] { describeWall(s.wall, v); });
  v.group("serve", "Servers for other programs and machines.", [&] { describeServe(s.serve, v); });
}

}  // namespace merlin
