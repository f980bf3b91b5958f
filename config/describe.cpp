// The only description of every setting: its key, range and meaning. The loader, the schema and
// `merlind --print-config` are generated from it.
#include <fmt/format.h>

#include "config/describe_page.h"
#include "config/describe_playlist.h"
#include "config/describe_projectors.h"
#include "config/describe_room.h"
#include "config/describe_shown.h"
#include "config/describe_stereo.h"
#include "config/settings.h"
#include "config/visitor.h"
#include "daemon/base/commands.h"

namespace merlin {
namespace {

constexpr const char* kSlot7Rules[] = {"zero", "neutral", "derived", "switch"};
constexpr const char* kTileKinds[] = {"wall", "operator"};
constexpr const char* kWhen[] = {"by_action", "enter", "hold", "leave"};
constexpr const char* kScripts[] = {"visit",     "turning", "still", "grabbing",
                                    "alignment", "panel",   "pushes"};

constexpr const char* kDialogues[] = {"binary", "text"};
constexpr const char* kWristLights[] = {"switch", "off", "on"};
constexpr const char* kTrackerNumbers[] = {"binary", "text", "short"};
constexpr const char* kGloves[] = {"cyberglove"};
constexpr const char* kTrackers[] = {"fastrak", "vrpn"};
constexpr const char* kBalls[] = {"spaceball", "spacenav", "evdev", "sample"};

void describeLine(LineSettings& line, std::span<const char* const> drivers, SettingsVisitor& v) {
  v.choiceOf("driver", line.driver, drivers, "Driver that speaks to the device.");
  v.text(
      "port", line.port,
      "Where the device is connected: serial:/dev/... (preferably a name under /dev/serial/by-id), "
      "pty:PATH, tcp://HOST:PORT (a raw serial server, or a VRPN server), unix:PATH (a socket, "
      "such as spacenavd's unix:/run/spnav.sock), evdev:/dev/input/... (an input device, "
      "preferably "
      "a name under /dev/input/by-id) or replay:FILE. Empty: no device. `merlin devices` lists "
      "what "
      "is plugged in.");
  static const std::string kBaud = fmt::format("Speed of the serial line in bits per second: {}.",
                                               fmt::join(lineSpeeds(), ", "));
  v.integer("baud", line.baud,
            {static_cast<double>(lineSpeeds().front()), static_cast<double>(lineSpeeds().back())},
            kBaud.c_str());
  v.integer("max_bytes_s", line.max_bytes_s, {0, 100'000'000},
            "Maximum number of bytes per second that are read from the device. A device that sends "
            "more is read at this rate and without real-time priority, and its health says so. "
            "0: four times the number that the baud rate allows, or 1000000 for a port that is "
            "neither serial: nor pty:.");
}

void describeGlove(DevicesSettings& d, SettingsVisitor& v) {
  describeLine(d.glove_line, kGloves, v);
  v.numbers(
      "offset", d.glove.offset, {-10000, 10000},
      "Raw sensor value at a joint angle of 0 rad, for each of the 23 sensor slots, 0 to 22.");
  v.numbers("gain", d.glove.gain, {-1, 1},
            "Change of the joint angle per raw count, in radians, for each of the 23 sensor slots, "
            "0 to 22; negative for a sensor that is mounted the other way round.");
  v.oneOf("slot7", d.glove.slot7, kSlot7Rules,
          "Value of sensor slot 7, the abduction of the index finger, which no known glove "
          "measures. zero: 0; neutral: the angle at the middle of the raw range; derived: the mean "
          "of slots 3 and 11, the abductions beside it; switch: the wrist switch (1 on, 0 off).");
  v.number("rate_hz", d.glove.rate_hz, {1, 150},
           "Records per second that merlind requests from the glove.");
  v.oneOf("dialogue", d.glove.dialogue, kDialogues,
          "Format of the glove's records and commands: binary, or text (decimal numbers), which "
          "takes four times as long to transmit.");
  v.oneOf("light", d.glove.light, kWristLights,
          "Light on the glove's wrist. switch: the light shows the state of the wrist switch; off "
          "or on: the light is always off or always on.");
  v.flag("time_stamps", d.glove.time_stamps,
         "Whether the glove's interface unit adds a time stamp to each record. Time stamps show "
         "which records were lost on the line, so that the sample counter can include them.");
  v.flag("filter", d.glove.filter,
         "Whether the low-pass filter in the glove's interface unit is on.");
}

void describeTrackerForm(FastrakSettings& t, SettingsVisitor& v) {
  constexpr const char* kAlignments[] = {"alignment1_cm", "alignment2_cm", "alignment3_cm",
                                         "alignment4_cm"};
  constexpr const char* kBoresights[] = {"boresight1_wxyz", "boresight2_wxyz", "boresight3_wxyz",
                                         "boresight4_wxyz"};
  for (std::size_t i = 0; i < 4; ++i) {
    v.numbers(kAlignments[i], t.alignment_cm[i], {-1000, 1000},
              "Alignment of the station whose number is in the key: the frame in which its "
              "positions are reported, as three points x, y, z in the transmitter's frame, in "
              "centimetres: the new origin, a point on the new x axis, a point on the new y axis.");
    v.numbers(kBoresights[i], t.boresight_wxyz[i], {-1, 1},
              "Boresight of the station whose number is in the key: the orientation of its "
              "receiver that counts as straight ahead, as a unit quaternion w, x, y, z in the "
              "frame that the station's alignment sets.");
  }
  v.numbers("position_filter", t.position_filter, {0, 1},
            "Adaptive low-pass filter for positions inside the tracker, as four numbers: "
            "sensitivity of the filter to motion; smallest filter coefficient, used at rest (the "
            "smaller, the smoother); largest filter coefficient, used in fast motion; factor that "
            "limits how fast the coefficient falls when a motion ends. If the second and third "
            "number are both 1, the filter is off.");
  v.numbers("angle_filter", t.angle_filter, {0, 1},
            "Adaptive low-pass filter for orientations inside the tracker, as four numbers: "
            "sensitivity of the filter to motion; smallest filter coefficient, used at rest (the "
            "smaller, the smoother); largest filter coefficient, used in fast motion; factor that "
            "limits how fast the coefficient falls when a motion ends. If the second and third "
            "number are both 1, the filter is off.");
  v.oneOf("numbers", t.numbers, kTrackerNumbers,
          "Format of numbers on the serial line: binary (floating-point numbers), text (decimal "
          "numbers) or short (14-bit integers, which only units made before 2012 support).");
  v.flag("angles", t.angles,
         "Whether the tracker sends orientations as azimuth, elevation and roll instead of "
         "quaternions. Samples contain quaternions either way.");
  v.flag("stylus", t.stylus,
         "Whether station 1 is a stylus; if so, each of its records contains the state of the "
         "stylus button.");
  v.numbers("stylus_tip_cm", t.stylus_tip_cm, {-100, 100},
            "Position of the stylus tip relative to the receiver coil in the stylus: x, y, z in "
            "centimetres.");
}

void describeVrpn(VrpnSettings& s, SettingsVisitor& v) {
  v.text("device", s.device,
         "Name of the tracker at the server, without @HOST, such as Tracker0. If it is wrong, the "
         "tracker's state names the devices that the server has.");
  v.numbers(
      "stations", s.stations, {VrpnSettings::kNoSensor, 9999},
      "The server's number of the sensor that is station 1, 2, 3 and 4; -1 for a station that "
      "is not used.");
  v.number("scale", s.scale, {1e-6, 1e3},
           "Metres in the server's unit of length: 1 for metres, which VRPN asks for, 0.001 for a "
           "server that sends millimetres.");
}

void describeTracker(DevicesSettings& d, SettingsVisitor& v) {
  describeLine(d.tracker_line, kTrackers, v);
  constexpr const char* kKeys[] = {"hemisphere1", "hemisphere2", "hemisphere3", "hemisphere4"};
  for (std::size_t i = 0; i < d.tracker.hemisphere.size(); ++i) {
    v.numbers(
        kKeys[i], d.tracker.hemisphere[i], {-1, 1},
        fmt::format("Hemisphere of operation of station {}: a vector in the transmitter's frame "
                    "that points into the half-space that contains the receiver. 0, 0, 0: the "
                    "tracker detects when the receiver crosses into the other half-space.",
                    i + 1)
            .c_str());
  }
  describeTrackerForm(d.tracker, v);
  v.flag("centimetres", d.tracker.centimetres,
         "Unit of positions on the serial line: true for centimetres, false for inches. Samples "
         "are in metres either way.");
  v.group(
      "vrpn",
      "Settings of the driver vrpn, for a tracker of a VRPN server. The tracker's other settings, "
      "except for driver and port, are those of a Fastrak and have no effect with it.",
      [&] { describeVrpn(d.vrpn, v); });
}

void describeSpacenav(SpacenavSettings& s, SettingsVisitor& v) {
  v.integer("full_scale", s.full_scale, {100, 32767},
            "Count of an axis at a full push or twist, as spacenavd sends it.");
  v.integer("dead_zone", s.dead_zone, {0, 99},
            "Largest count of an axis, positive or negative, that is treated as rest.");
  v.numbers("axis_map", s.axis_map, {-6, 6},
            "Axis of spacenavd for each of x, y, z and the rotations about x, y, z: 1 to 3 are its "
            "x, y, z, and 4 to 6 its rotations; a negative number reverses the axis.");
}

void describeEvdev(EvdevSettings& e, SettingsVisitor& v) {
  static const std::string kAxes = fmt::format(
      "Axis of the input device for each of x, y, z and the rotations about x, y, z, as six texts: "
      "{}. Empty: as fits the kind of device.",
      kAxisForms);
  v.texts("axes", e.axes, kAxes.c_str());
  v.texts(
      "buttons", e.buttons,
      "Keys of the input device that are ball.button.1, 2 and so on: the kernel's names without "
      "KEY_ or BTN_, in lower case, such as south, tl or pagedown. Empty: the first twelve "
      "buttons of the device.");
  v.number("dead_zone", e.dead_zone, {0, 0.9},
           "Share of an axis's full deflection, to either side, that is treated as rest.");
  v.number("curve", e.curve, {1, 5},
           "Exponent of the response to an axis's deflection: 1 is linear; the greater, the finer "
           "are small deflections.");
}

void describeBall(DevicesSettings& d, SettingsVisitor& v) {
  describeLine(d.ball_line, kBalls, v);
  v.integer("full_scale_translation", d.ball.full_scale_translation, {100, 32767},
            "Raw count of a translation axis at a full push of the ball.");
  v.integer("full_scale_rotation", d.ball.full_scale_rotation, {100, 32767},
            "Raw count of a rotation axis at a full twist of the ball.");
  v.integer("null_region", d.ball.null_region, {0, 63},
            "Size of the null region inside the ball, in the ball's own units: it reports weaker "
            "pushes and twists as zero.");
  v.flag("cubic", d.ball.cubic,
         "Whether the response of the ball itself is cubic instead of linear, which amplifies hard "
         "pushes more than gentle ones.");
  v.flag("rezero", d.ball.rezero,
         "Whether the ball takes its present state as its rest position when merlind opens it. "
         "Nobody may touch the ball at that moment.");
  v.text("beep", d.ball.beep,
         "Tune that the ball beeps when it is ready: a lower-case letter is a tone, an upper-case "
         "letter a pause; letters nearer to a are shorter. Empty: no tune.");
  v.integer("dead_zone", d.ball.dead_zone, {0, 99},
            "Largest raw count of an axis, positive or negative, that is treated as rest.");
  v.numbers("axis_map", d.ball.axis_map, {-6, 6},
            "Device axis for each of x, y, z and the rotations about x, y, z: 1 to 3 are the "
            "device's X, Y, Z, and 4 to 6 its rotations A, B, C; a negative number reverses the "
            "axis.");
  v.group("spacenav", "Settings of the driver spacenav, for a space mouse that spacenavd reads.",
          [&] { describeSpacenav(d.spacenav, v); });
  v.group("evdev",
          "Settings of the driver evdev, for a gamepad, joystick, space mouse or clicker that the "
          "kernel reads.",
          [&] { describeEvdev(d.evdev, v); });
}

// What a room computes, if there is one.
void describeFrame(render::tiles::TilesSettings& t, SettingsVisitor& v) {
  constexpr Range kFrame{16, render::tiles::kLargestFrame_px};
  v.integer("frame_width", t.frame_width, kFrame,
            "Width of the frame, which contains all tiles, in pixels. Not with /wall/room.");
  v.integer("frame_height", t.frame_height, kFrame,
            "Height of the frame, which contains all tiles, in pixels. Not with /wall/room.");
  v.number("field_of_view_deg", t.field_of_view_deg, {1, 179},
           "Horizontal field of view of one tile, in degrees. Not with /wall/room.");
}

void describeTiles(render::tiles::TilesSettings& t, bool from_room, SettingsVisitor& v) {
  v.integer("tile_width", t.tile_width, {16, 8192},
            "Width in pixels of each tile that does not set its own.");
  v.integer("tile_height", t.tile_height, {16, 8192},
            "Height in pixels of each tile that does not set its own.");
  if (!from_room) describeFrame(t, v);
  v.number("near_m", t.near_m, {0.001, 1000},
           "Distance of the near clipping plane in metres: nothing nearer is drawn.");
  v.number("far_m", t.far_m, {0.01, 1e6},
           "Distance of the far clipping plane in metres: nothing farther is drawn.");
  if (from_room) {
    for (const char* const key : {"frame_width", "frame_height", "field_of_view_deg", "tiles"}) {
      v.excluded(key,
                 "is given together with /wall/room, from which it is computed: leave out one of "
                 "the two");
    }
    return;
  }
  v.listOf<render::tiles::TileSettings>(
      "tiles", t.tiles,
      "Position of each tile in the frame, and what it shows. Not with /wall/room.",
      [&](render::tiles::TileSettings& tile) {
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
        v.integer("width", tile.width, {0, 8192},
                  "Width of this tile in pixels; 0: the width /wall/tiles/tile_width.");
        v.integer("height", tile.height, {0, 8192},
                  "Height of this tile in pixels; 0: the height /wall/tiles/tile_height.");
        v.numbers("direction_deg", tile.direction_deg, {-180, 180},
                  "Direction of the tile's view in addition to turns, in degrees: yaw to the left, "
                  "then pitch upwards, then roll counter-clockwise as the viewer sees it.");
        v.numbers("frustum_deg", tile.frustum_deg, {-89.5, 89.5},
                  "Angles of the left, right, lower and upper edge of the tile from its direction, "
                  "in degrees; left and lower ones are negative. All 0: a symmetric frustum with "
                  "the field of view /wall/tiles/field_of_view_deg. Views of different tiles may "
                  "overlap.");
        v.numbers("screen_m", tile.screen_m, {-1000, 1000},
                  "Lower left, lower right and upper left corner of the tile's screen relative to "
                  "the eye (x right, y up, z towards the person), in metres. The tile's direction "
                  "and frustum are computed from these corners. All 0: no screen is given.");
        describeView(tile.view, tile.camera, v);
      });
}

void describeScene(render::scene::SceneSettings& s, SettingsVisitor& v) {
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
            "Speed of the model or viewer along x, y, z at a full push of the ball, in metres per "
            "second.");
  v.numbers(
      "ball_turn_deg_s", s.ball_turn_deg_s, {-3600, 3600},
      "Angular speed of the model or viewer about x, y, z at a full twist of the ball, in degrees "
      "per second.");
  v.numbers("tracker_axes", s.tracker_axes, {-3, 3},
            "Axes of the tracker that correspond to the wall's x (right), y (up) and z (towards "
            "the person): 1 is x, 2 is y, 3 is z; a negative number reverses the axis.");
  v.number(
      "hand_gain", s.hand_gain, {0.01, 1000},
      "Motion of the model in metres for one metre of motion of the hand, while the action grab is "
      "held.");
  v.number("fly_gain", s.fly_gain, {0.01, 1000},
           "Speed of the viewer in metres per second for one metre between the hand and the place "
           "where the hand was when the action fly began.");
  v.numbers("tracker_origin_m", s.tracker_origin_m, {-100, 100},
            "Position of the tracker's transmitter relative to the eye, used for pointing: x "
            "right, y up, z towards the person, in metres.");
  v.number(
      "wall_distance_m", s.wall_distance_m, {0.1, 100},
      "Distance from the eye to the wall, used when the hand points past the model, in metres.");
  v.number(
      "hand_noise_m", s.hand_noise_m, {0, 1},
      "Motion of the hand below this distance is treated as noise of the tracker, in metres; a "
      "motion from rest must exceed twice this distance.");
  v.number(
      "hand_noise_deg", s.hand_noise_deg, {0, 180},
      "Rotation of the hand below this angle is treated as noise of the tracker, in degrees; a "
      "rotation from rest must exceed twice this angle.");
  v.number("still_after_s", s.still_after_s, {0.01, 10},
           "Time without input after which the scene counts as still, in seconds.");
  v.number("return_after_s", s.return_after_s, {0, 86400},
           "Time in seconds after which the initial view returns if no tile of kind wall shows any "
           "part of the model; the view does not return while something moves. 0: never.");
}

void describeRenderer(render::frame::RenderSettings& r, SettingsVisitor& v) {
  v.oneOf("backend", r.gl.backend, render::gl::kGlBackendNames,
          "OpenGL implementation that draws without a window: egl (with a GPU or in software) or "
          "osmesa (software).");
  v.text("gpu", r.gl.gpu,
         "GPU that draws, with backend egl. auto: the first GPU that works, otherwise the software "
         "renderer; none: the software renderer; otherwise the GPU with this number, DRM node, PCI "
         "address or part of its name. `merlin wall gpus` lists them.");
  v.integer("contexts", r.gl.contexts, {0, 2},
            "Number of OpenGL contexts that divide the tiles among them, each in its own thread; 2 "
            "needs EGL. 0: two for a software renderer on two cores or more, otherwise one.");
  v.oneOf("read_back", r.gl.read_back, render::gl::kReadBackNames,
          "How a frame's pixels are read back. direct: each tile as soon as it is drawn; "
          "asynchronous: into pixel buffers, while the tiles after it are drawn. auto: "
          "asynchronous from a GPU, direct from a software renderer.");
  v.oneOf("correction", r.correction, render::frame::kCorrectionPlaceNames,
          "Where corrections of outputs are computed: on the cpu, or by a shader on the gpu (in "
          "software, if that is what draws). auto: by a shader if a GPU draws, otherwise on the "
          "CPU.");
  v.integer("raster_threads", r.gl.raster_threads, {0, 16},
            "Number of rasterizer threads of Mesa's software renderer; 0: the drawing thread "
            "itself rasterizes.");
}

void describeRender(render::frame::RenderSettings& r, SettingsVisitor& v) {
  describeRenderer(r, v);
  v.text("show", r.model.show.feature,
         "Name of the vertex feature that the model's colours show (thermal, confidence ...); a "
         "feature with one value per vertex is shown on a colour scale. Every model must have this "
         "feature. Empty: the model's own colours.");
  v.numbers("show_range", r.model.show.range, {-1e9, 1e9},
            "Values of the feature named by show at the first and last colour of the scale. Two "
            "equal numbers: from the 1st to the 99th percentile of the model's values.");
  v.flag(
      "view_dependent", r.model.view_dependent,
      "Whether the resolution depends on the view: most triangles are in the parts of the model "
      "that the tiles show, and more densely near the eye. Otherwise the resolution is uniform.");
  v.number("geomorph", r.model.geomorph, {0, 0.5},
           "Share of the triangles whose vertices move gradually to the position where they will "
           "merge (geomorphs), so that a change of detail is not visible as a jump. 0: vertices "
           "jump.");
  v.integer(
      "picture_memory_mb", r.picture_memory_mb, {64, 65'536},
      "Most memory that the tiles of the shown picture take, in megabytes: in main memory and in "
      "the textures of all drawing contexts together.");
  v.integer("fade_frames", r.fade_frames, {1, 30},
            "Number of frames over which a finer image of a still scene is faded in over the "
            "coarser one; 1: the finer image is shown at once.");
  v.numbers(
      "colour", r.model.style.colour, {0, 1},
      "Colour of a model that has no colours of its own: red, green, blue, each from 0 to 1.");
  v.numbers("background", r.model.style.background, {0, 1},
            "Background colour: red, green, blue, each from 0 to 1.");
  v.number("brightness", r.model.style.brightness, {0.1, 10},
           "Factor that multiplies the model's colours; above 1 for dark scans.");
  v.flag("draw_back_faces", r.model.style.draw_back_faces,
         "Whether back faces are drawn too, for open scans that are seen from behind. Drawing "
         "then takes 1.6 to 1.9 times as long.");
  v.flag("wireframe", r.model.style.wireframe, "Whether edges are drawn instead of faces.");
}

void describeGpio(GpioSettings& g, SettingsVisitor& v) {
  v.text("chip", g.chip,
         "GPIO chip of the control panel: gpiochip0 or /dev/gpiochip0. Empty: there is no panel.");
  v.integer("projector_line", g.projector_line, {-1, 1023},
            "Number of the GPIO line that merlind sets high to power the projectors; -1: no such "
            "line.");
  v.integer("video_line", g.video_line, {-1, 1023},
            "Number of the GPIO line that controls the video switch, low for input A and high for "
            "input B; -1: no such line.");
  v.integer("lamp_line", g.lamp_line, {-1, 1023},
            "Number of the GPIO line that merlind sets high to light the status lamp; -1: no such "
            "line.");
  v.integer("button_line", g.button_line, {-1, 1023},
            "Number of the GPIO line that is high while the panel's button is pressed; -1: no such "
            "line.");
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

// Description of the setting action: lists all actions with the help text of each.
std::string actionsHelp() {
  std::string held, once;
  for (const CommandInfo& c : kCommands) {
    if (c.bindable == Bindable::kNo) continue;
    std::string& list = c.bindable == Bindable::kHeld ? held : once;
    list += fmt::format("{}{}: {}", list.empty() ? "" : " ", c.name, c.help);
  }
  return fmt::format(
      "Action of the input. Actions that last as long as the input is held: {} Actions that happen "
      "once: {}",
      held, once);
}

void describeBindings(DevicesSettings& d, SettingsVisitor& v) {
  static const std::string kInput = fmt::format("Name of the input: {}.", kInputForms);
  static const std::string kAction = actionsHelp();
  v.listOf<Binding>(
      "bindings", d.bindings,
      "Inputs (buttons, postures, switches) and the action of each. Every merlind that draws a "
      "wall executes the actions for walls, also on another machine; the merlind that has the "
      "control panel executes the actions for the panel.",
      [&](Binding& b) {
        v.text("input", b.input, kInput.c_str());
        v.choiceOf("action", b.action, kActions, kAction.c_str());
        v.oneOf("on", b.when, kWhen,
                "When the action happens: hold (as long as the button is pressed or the posture is "
                "held), enter (once, when that begins) or leave (once, when that ends). by_action: "
                "hold for actions that last, enter for the others.");
      });
  v.number("stale_after_s", d.stale_after_s, {0.1, 10},
           "Time after which the buttons and postures of a device that has stopped working count "
           "as released, in seconds.");
}

void describeServe(ServeSettings& s, SettingsVisitor& v) {
  v.path("spnav_socket", s.spnav_socket,
         "Unix socket from which programs that use libspnav receive the Spaceball's data, usually "
         "/run/spnav.sock. Empty: no such server.");
  v.integer("vrpn_port", s.vrpn_port, {0, 65535},
            "Port from which VRPN clients on this machine receive the data of hand, tracker and "
            "ball, usually 3883; 0: no such server.");
  v.text("samples_endpoint", s.samples_endpoint,
         "Address from which walls on other machines receive the devices' samples, encrypted, such "
         "as tcp://*:7401. Empty: no such server.");
  v.secretFile("samples_keys", s.samples_keys,
               "File with this machine's key pair, written by `merlin keys -o FILE`.");
  v.path("samples_clients", s.samples_clients,
         "File with the public keys of the machines that may receive samples, one per line.");
  v.text("wall_endpoint", s.wall_endpoint,
         "Address at which the wall answers status and commands of other machines, encrypted, such "
         "as tcp://*:7402. Empty: not at all.");
  v.text("devices_endpoint", s.devices_endpoint,
         "The same of the devices, at a port of its own, such as tcp://*:7403.");
  v.secretFile("commands_keys", s.commands_keys,
               "File with this machine's key pair for these addresses, written by `merlin keys -o "
               "FILE`.");
  v.path("commands_clients", s.commands_clients,
         "File with the public keys of those who may send commands to these addresses, one per "
         "line.");
  v.path("commands_readers", s.commands_readers,
         "File with the public keys of those who may only read status and events there, one per "
         "line.");
}

void describeMesh(render::correct::MeshSettings& m, SettingsVisitor& v) {
  v.integer("columns", m.columns, {0, render::correct::kMostMeshSide},
            "Number of points in a row of the grid, at least 2; 0: no mesh.");
  v.integer("rows", m.rows, {0, render::correct::kMostMeshSide},
            "Number of rows of points, at least 2; 0: no mesh.");
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
        v.number("x", p.x, range, "From the left border, as a share of the output's width.");
        v.number("y", p.y, range, "From the top border, as a share of the output's height.");
      });
}

void describeCorrection(render::correct::CorrectionSettings& c, SettingsVisitor& v) {
  v.numbers("corners", c.corners,
            {-render::correct::kMostCornerOffset, render::correct::kMostCornerOffset},
            "Corner pin: how far the picture's upper left, upper right, lower left and lower right "
            "corner are moved from the output's corners, in pixels, x to the right and y down "
            "each. It is applied after mesh or mpcdi.");
  v.group("mesh", "Warp by a grid of points, each of which is moved on its own.",
          [&] { describeMesh(c.mesh, v); });
  v.path("mpcdi", c.mpcdi,
         "MPCDI file (profile 2d) with a measured warp and blend, in place of mesh, the ramps of "
         "blend and black. Empty: none.");
  v.text("mpcdi_region", c.mpcdi_region,
         "Region of the MPCDI file that belongs to this output. Empty: the file's only one.");
  v.group(
      "blend",
      "Edge blending: strips of the picture that a neighbour shows as well. The "
      "light decreases towards the border, so that both strips together are as bright as the rest "
      "of the picture.",
      [&] {
        const Range pixels{0, render::correct::kMostCornerOffset};
        v.number(
            "left", c.blend.left, pixels,
            "Width of the strip at the left border in pixels of the picture before the warp; 0: "
            "none.");
        v.number("right", c.blend.right, pixels,
                 "Width of the strip at the right border in pixels of the picture before the warp; "
                 "0: none.");
        v.number("top", c.blend.top, pixels,
                 "Height of the strip at the top border in pixels of the picture before the warp; "
                 "0: none.");
        v.number("bottom", c.blend.bottom, pixels,
                 "Height of the strip at the bottom border in pixels of the picture before the "
                 "warp; 0: none.");
        v.number(
            "gamma", c.blend.gamma, {render::correct::kLeastGamma, render::correct::kMostGamma},
            "Gamma of the projector or display: light = signal ^ gamma. Blend, colour and black "
            "level are computed in linear light.");
      });
  v.group("colour", "Correction of colours, in linear light.", [&] {
    const Range range{-render::correct::kMostColour, render::correct::kMostColour};
    v.numbers("matrix", c.colour.matrix, range,
              "Matrix that the light is multiplied by: three rows for red, green and blue of the "
              "output, of three numbers for red, green and blue of the picture.");
    v.numbers("gain", c.colour.gain, {0, render::correct::kMostColour},
              "Factor on the light of red, green and blue, after the matrix.");
    v.numbers("gamma", c.colour.gamma,
              {render::correct::kLeastChannelGamma, render::correct::kMostChannelGamma},
              "Gamma of the output's red, green and blue, as factors on blend.gamma. Above 1 the "
              "middle tones of the channel become brighter.");
  });
  v.group("black", "Black level.", [&] {
    v.numbers("level", c.black.level, {0, render::correct::kMostBlack},
              "Linear light of red, green and blue that is added outside the blend strips, as a "
              "share of full brightness. It raises black there to the level of the overlap, where "
              "the black levels of the projectors add up.");
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
            "Width of the window when it opens, in pixels; 0: that of the output's picture.");
  v.integer("height", w.height, {0, 16384},
            "Height of the window when it opens, in pixels; 0: that of the output's picture.");
  v.flag("fullscreen", w.fullscreen,
         "Whether the window covers its monitor when it opens. The key F11 changes it.");
  v.flag("border", w.border, "Whether the desktop draws a frame and a title around the window.");
  v.oneOf("scale", w.scale, render::out::kWindowScaleNames,
          "How the picture is shown in a window of another size. fit: scaled to the largest size "
          "that fits, with black bars; none: at its own size, in the middle of the window.");
  v.oneOf(
      "on_close", w.on_close, render::out::kOnCloseNames,
      "What happens when a person closes the window. health: only this output stops, its health "
      "says so, and the window is back when merlind is restarted; stop: merlind ends.");
  v.flag("input", w.input,
         "Whether mouse and keys in the window act on the wall; render/out/window/README.md lists "
         "what they do.");
}

void describeKms(render::out::kms::KmsSettings& k, SettingsVisitor& v) {
  v.text("card", k.card,
         "Device file of the graphics card, for example /dev/dri/card0. Empty: the first card that "
         "has connectors. All displays of a card change in one frame.");
  v.text("connector", k.connector,
         "Name of the connector that the display is plugged in at, as in /sys/class/drm, for "
         "example HDMI-A-1. Empty: the first connector that has a display; only for a single "
         "output on its card. *: every connector of the card that has a display and that no other "
         "output names; that there is none, or no card, is then no fault.");
  v.text("mode", k.mode,
         "Mode of the display, WIDTHxHEIGHT or WIDTHxHEIGHT@HZ, for example 1920x1080@60. Empty: "
         "the mode with the size of the picture if the display has one, otherwise the mode that "
         "the display prefers. A smaller picture is shown in the middle, surrounded by black.");
}

void describeWall(WallSettings& w, SettingsVisitor& v) {
  v.group(
      "input", "Another machine whose devices this wall uses instead of this machine's devices.",
      [&] {
        v.text(
            "endpoint", w.input.endpoint,
            "Address of the merlind that reads the devices, tcp://HOST:PORT. Empty: the wall uses "
            "the devices of this machine.");
        v.text("server_key", w.input.server_key, "Public key of the merlind at endpoint.");
        v.secretFile("keys", w.input.keys,
                     "File with this machine's key pair, written by `merlin keys -o FILE`.");
      });
  v.path("model", w.model,
         "Multiresolution model that is shown first, an .mrm file; empty: the first of contents is "
         "shown first.");
  v.listOf<ContentSettings>("contents", w.contents,
                            "Further contents, which the command next_content shows in turn. "
                            "Each names a model, a picture or a folder of slides.",
                            [&](ContentSettings& c) {
                              v.text("name", c.name,
                                     "Name of the content, for `merlin show`; empty: the name of "
                                     "its file without the ending.");
                              v.path("model", c.model, "Multiresolution model, an .mrm file.");
                              v.path("picture", c.picture,
                                     "Picture or panorama, a pyramid (.tif) that `merlin image "
                                     "import` makes.");
                              v.path("slides", c.slides,
                                     "Folder of pyramids (.tif), which next_content shows one "
                                     "after another, in the order of their names.");
                              v.oneOf("show_as", c.show_as, render::content::kShowAsNames,
                                      "Kind of the picture or the slides. marked: a panorama if "
                                      "it was imported with --panorama, otherwise a plane.");
                            });
  v.group("playlist",
          "What the wall shows while nobody touches it: its contents in turn. It ends at the first "
          "touch, with the content that is shown then, at full brightness.",
          [&] { describePlaylist(w.playlist, v); });
  v.group("shown", "Files that `merlin show FILE` shows.", [&] { describeShown(w.shown, v); });
  v.group(
      "rate",
      "The frame rate, and limits of the number of triangles, which is adapted to keep the rate.",
      [&] {
        v.number("rate_hz", w.governor.rate_hz, {1, 240},
                 "Frames per second while anything moves.");
        v.integer(
            "min_triangles", w.governor.min_triangles, {4, 1e6},
            "Minimum number of triangles per frame while anything moves, even if frames are late.");
        v.integer("max_triangles", w.governor.max_triangles, {4, 1e9},
                  "Maximum number of triangles per frame while anything moves.");
        v.integer("first_triangles", w.governor.first_triangles, {4, 1e9},
                  "Number of triangles per frame until the first frame time has been measured.");
        v.number("late_share", w.governor.late_share, {0.0001, 0.5},
                 "Share of frames that may be late in the long run; the time that is kept in "
                 "reserve in each frame is adapted to it.");
      });
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
  v.group("operator", "What is drawn over the picture on tiles of kind operator.", [&] {
    v.flag("overlay", w.operator_tile.overlay,
           "Whether rate, frame times, detail, content, posture, devices and messages are drawn "
           "over the picture. A tile of less than 320 x 240 pixels has no room for them.");
    v.flag(
        "panel", w.operator_tile.panel,
        "Whether there is a panel with buttons on the operator's tile (the first one of at least "
        "320 x 240 pixels), worked by a mouse or a finger in a window, by a VNC client and by the "
        "ball: kind of content, content, pan, tilt, zoom, rate and detail by hand, projectors, "
        "lamp. The ball works it after the action operator_panel.");
  });
  v.path("snapshots", w.snapshots,
         "Folder for the frames that the action snapshot writes. Empty: snapshots are off.");
  v.integer("snapshots_kept", w.snapshots_kept, {1, 1e6},
            "Number of snapshots kept in the folder; the oldest are removed.");
  v.listOf<render::out::OutputSettings>(
      "outputs", w.outputs,
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
                 "shows, in seconds. What it shows is read back and compared with what was meant; "
                 "black, frozen or another program's picture is an event of kind picture. 0: "
                 "never checked.");
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
                      "Clockwise rotation of the tile after mirroring, in degrees, for a projector "
                      "or display that is mounted on its side or upside down.");
            });
        v.group("correction",
                "What is done to the picture so that it looks as meant on this output's screen: "
                "warp, blend, colour, black level. Not for kind shared_memory.",
                [&] { describeCorrection(o.correction, v); });
      });
}

}  // namespace

void describe(Settings& s, SettingsVisitor& v) {
  v.text("instance", s.instance,
         "Name of this daemon. It is part of the names of shared memory and sockets and so "
         "distinguishes several daemons on one machine.");
  v.path(
      "run_directory", s.run_directory,
      "Folder for sockets and for the emulators' pseudo-terminals. Empty: the folder that "
      "systemd sets, otherwise /run/merlin for root, and for other users $XDG_RUNTIME_DIR/merlin "
      "or /tmp/merlin-UID.");
  v.path("state_file", s.state_file,
         "File in which merlind keeps what people change while it runs (the alignment of outputs, "
         "the frame rate, the content that is shown, that the playlist or the projectors were "
         "switched off), so that it is there after a restart. Empty: "
         "INSTANCE.state.json in the folder that systemd sets, otherwise in /var/lib/merlin for "
         "root, and for other users in $XDG_STATE_HOME/merlin or ~/.local/state/merlin.");
  v.group("devices", "The devices that are read.", [&] {
    v.group("glove", "A CyberGlove.", [&] { describeGlove(s.devices, v); });
    v.group("tracker", "A Polhemus Fastrak.", [&] { describeTracker(s.devices, v); });
    v.group("ball", "A Spaceball.", [&] { describeBall(s.devices, v); });
    v.group("hand", "The hand, which combines glove and tracker.", [&] {
      v.integer(
          "station", s.devices.hand.station, {1, 4},
          "Tracker station that is worn on the hand, 1 to 4; it moves the model while the action "
          "grab is held. A wall that uses the devices of another machine needs this setting in its "
          "own configuration.");
      v.number("cutoff_hz", s.devices.hand.cutoff_hz, {0, 100},
               "Cut-off frequency f, in Hz, of the low-pass filter for the hand's pose while the "
               "hand is at rest. The filter adds a delay of 1 / (2 pi f) seconds. 0: no filter.");
      v.number(
          "cutoff_per_m_s", s.devices.hand.cutoff_per_m_s, {0, 1000},
          "Increase of the cut-off frequency of the filter for the hand's pose with the hand's "
          "speed, in Hz per metre per second.");
    });
    v.group("gpio", "The wall's control panel on a GPIO chip.",
            [&] { describeGpio(s.devices.gpio, v); });
    describeProjectors(s.devices, v);
    v.path("postures", s.devices.postures,
           "File of the neural network that recognises postures, in JSON. Empty: no posture is "
           "recognised.");
    v.number("posture_hold_s", s.devices.posture_hold.hold_s, {0, 10},
             "Minimum time that a posture must be held before it counts as begun, in seconds.");
    v.number("posture_leave_s", s.devices.posture_hold.leave_s, {0, 10},
             "Minimum time that a posture must be absent before it counts as ended, in seconds.");
    v.number("posture_margin", s.devices.posture_hold.least_margin, {0, 1},
             "Minimum margin for a posture to be recognised, from 0 to 1: the margin says how sure "
             "the posture network is. Half of it suffices to keep the current posture.");
    v.flag(
        "posture_drift", s.devices.posture_drift,
        "Whether merlind follows the slow drift of the glove's sensors: from postures that it is "
        "sure of it learns by how much each sensor has moved, at most 0.3 of its range, and "
        "subtracts that before it recognises. Forgotten when the glove is connected again.");
    describeBindings(s.devices, v);
    v.integer("cpu_latency_us", s.devices.cpu_latency_us, {-1, 10000},
              "Maximum time that idle CPU cores may take to wake up, for the whole machine, in "
              "microseconds. 0 keeps them from sleeping, which costs power; -1 leaves the system's "
              "setting.");
    v.choiceOf(
        "script", s.devices.script, kScripts,
        "What the emulated person does when merlind runs with --emulate. visit: turns the "
        "model, rests, grabs it, lets go; turning: always twists the ball; still: does "
        "nothing; grabbing: makes a fist and opens it in turn while the hand moves; "
        "alignment: makes the movements that `merlin calibrate tracker` asks for; pushes: those "
        "that `merlin calibrate ball` asks for.");
  });
  v.group("wall", "What the wall shows, how it is drawn, and which outputs receive the frames.",
          [&] { describeWall(s.wall, v); });
  v.group("serve", "Servers for other programs and machines.", [&] { describeServe(s.serve, v); });
  v.group("page", "The web page of the operator, which `merlind --role page` serves.",
          [&] { describePage(s.page, v); });
  v.listOf<AlarmSettings>("alarms", s.alarms,
                          "Programs that `merlind --role alarms` starts when something happens.",
                          [&](AlarmSettings& a) { describeAlarm(a, v); });
}

}  // namespace merlin
