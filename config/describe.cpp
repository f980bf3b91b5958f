// The one description of every setting: its key, its range, its meaning. The loader, the schema and
// `merlind --print-config` follow from it.
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
  v.choiceOf("driver", line.driver, drivers, "Which device it is.");
  v.text("port", line.port,
         "Where the device is: serial:/dev/... (best a name under /dev/serial/by-id), pty:PATH, "
         "tcp://HOST:PORT (a raw serial server) or replay:FILE; empty: there is none.");
  v.integer("baud", line.baud, {1200, 115200},
            "Speed of the line, bits a second: 1200, 2400, ... 38400, 57600 or 115200.");
  v.integer("max_bytes_s", line.max_bytes_s, {0, 100'000'000},
            "Bytes a second that are read, at most; a line that sends more is read at this pace, "
            "without real-time priority, and its health says so. 0: four times what its baud "
            "carry; of tcp:// and replay: 1000000.");
}

void describeGlove(DevicesSettings& d, SettingsVisitor& v) {
  describeLine(d.glove_line, kGloves, v);
  v.numbers("offset", d.glove.offset, {-10000, 10000},
            "Of each slot 0 to 22: the raw value at 0 rad.");
  v.numbers("gain", d.glove.gain, {-1, 1},
            "Of each slot 0 to 22: radians for one raw count; negative for a sensor that is turned "
            "round.");
  v.oneOf("slot7", d.glove.slot7, kSlot7Rules,
          "What fills slot 7, which no glove measures: 0, the middle, its neighbours' mean, or the "
          "wrist switch.");
  v.number("rate_hz", d.glove.rate_hz, {1, 150}, "Records a second that are asked for.");
  v.oneOf(
      "dialogue", d.glove.dialogue, kDialogues,
      "How the interface unit is spoken to: in bytes, or in decimal text, which takes four times "
      "the line's time.");
  v.oneOf("light", d.glove.light, kWristLights, "The wrist's light: as the switch, off, or on.");
  v.flag("time_stamps", d.glove.time_stamps,
         "The unit stamps its records: the counter then also grows by records that were lost.");
  v.flag("filter", d.glove.filter, "The interface unit's own low-pass filter.");
}

void describeTrackerForm(FastrakSettings& t, SettingsVisitor& v) {
  constexpr const char* kAlignments[] = {"alignment1_cm", "alignment2_cm", "alignment3_cm",
                                         "alignment4_cm"};
  constexpr const char* kBoresights[] = {"boresight1_wxyz", "boresight2_wxyz", "boresight3_wxyz",
                                         "boresight4_wxyz"};
  for (std::size_t i = 0; i < 4; ++i) {
    v.numbers(
        kAlignments[i], t.alignment_cm[i], {-1000, 1000},
        "Of that station: a new origin, a point on its x axis, one on its y axis, centimetres.");
    v.numbers(kBoresights[i], t.boresight_wxyz[i], {-1, 1},
              "Of that station: the orientation that counts as straight ahead, a quaternion.");
  }
  v.numbers("position_filter", t.position_filter, {0, 1},
            "The unit's own, of positions: sensitivity, low, high, factor.");
  v.numbers("angle_filter", t.angle_filter, {0, 1}, "The same, of angles.");
  v.oneOf("numbers", t.numbers, kTrackerNumbers,
          "On its line: floats, decimals, or 14-bit numbers (boxes of before 2012).");
  v.flag("angles", t.angles, "Sends azimuth, elevation and roll in place of a quaternion.");
  v.flag("stylus", t.stylus, "Station 1 is a stylus: its button comes with the records.");
  v.numbers("stylus_tip_cm", t.stylus_tip_cm, {-100, 100},
            "Of the stylus, from its coil, centimetres.");
}

void describeTracker(DevicesSettings& d, SettingsVisitor& v) {
  describeLine(d.tracker_line, kTrackers, v);
  constexpr const char* kKeys[] = {"hemisphere1", "hemisphere2", "hemisphere3", "hemisphere4"};
  for (std::size_t i = 0; i < d.tracker.hemisphere.size(); ++i) {
    v.numbers(kKeys[i], d.tracker.hemisphere[i], {-1, 1},
              "Into the half of space where that station's receiver is, transmitter's frame; 0, 0, "
              "0: the unit follows it.");
  }
  describeTrackerForm(d.tracker, v);
  v.flag("centimetres", d.tracker.centimetres,
         "What the unit sends on its line, else inches; samples are in metres.");
}

void describeBall(DevicesSettings& d, SettingsVisitor& v) {
  describeLine(d.ball_line, kBalls, v);
  v.integer("full_scale_translation", d.ball.full_scale_translation, {100, 32767},
            "Counts of a full push.");
  v.integer("full_scale_rotation", d.ball.full_scale_rotation, {100, 32767},
            "Counts of a full twist.");
  v.integer("null_region", d.ball.null_region, {0, 63},
            "The ball's own: push that counts as none.");
  v.flag("cubic", d.ball.cubic,
         "The ball's own: a harder push counts for more than in proportion.");
  v.flag("rezero", d.ball.rezero,
         "Its rest is taken anew when it is opened: nobody may touch it then.");
  v.text(
      "beep", d.ball.beep,
      "What it beeps when it is ready: letters, lower case a tone, upper a pause; empty: nothing.");
  v.integer("dead_zone", d.ball.dead_zone, {0, 99}, "Counts of an axis that are taken for rest.");
  v.numbers(
      "axis_map", d.ball.axis_map, {-6, 6},
      "For x, y, z and the turns about them: the device's axis 1 to 6, negative to turn it round.");
}

void describeTiles(render::TilesSettings& t, SettingsVisitor& v) {
  v.integer("tile_width", t.tile_width, {16, 8192}, "Of each tile, pixels.");
  v.integer("tile_height", t.tile_height, {16, 8192}, "Of each tile, pixels.");
  v.integer("frame_width", t.frame_width, {16, 16384}, "Of the frame buffer, pixels.");
  v.integer("frame_height", t.frame_height, {16, 16384}, "Of the frame buffer, pixels.");
  v.number("field_of_view_deg", t.field_of_view_deg, {1, 179},
           "Of one tile, horizontally, degrees.");
  v.number("near_m", t.near_m, {0.001, 1000}, "Nothing nearer is drawn, metres.");
  v.number("far_m", t.far_m, {0.01, 1e6}, "Nothing further is drawn, metres.");
  v.listOf<render::TileSettings>(
      "tiles", t.tiles, "Where each tile lies in the frame buffer, and what it shows.",
      [&](render::TileSettings& tile) {
        v.text("name", tile.name, "Of the tile.");
        v.oneOf("kind", tile.kind, kTileKinds,
                "A piece of the wall's picture, or the operator's view of the whole model.");
        v.integer("x", tile.x, {0, 16384}, "Of its upper left corner in the frame buffer, pixels.");
        v.integer("y", tile.y, {0, 16384}, "Of its upper left corner in the frame buffer, pixels.");
        v.number("turns", tile.turns, {-8, 8},
                 "How far it is turned, in tile widths; +1 is one to the left.");
      });
}

void describeScene(render::SceneSettings& s, SettingsVisitor& v) {
  v.number("model_radius_m", s.model_radius_m, {0.001, 1000},
           "The model is scaled to a bounding sphere of this radius, metres.");
  v.number("model_distance_m", s.model_distance_m, {0, 1000},
           "Of the model's centre in front of the eye, metres.");
  v.number("model_yaw_deg", s.model_yaw_deg, {-360, 360},
           "The model is turned about the vertical axis at first, degrees.");
  v.number("model_pitch_deg", s.model_pitch_deg, {-360, 360},
           "And about the horizontal one before that, degrees: -90 for a model whose up is z.");
  v.numbers("ball_speed_m_s", s.ball_speed_m_s, {-100, 100},
            "At a full push of the ball along x, y, z, metres a second.");
  v.numbers("ball_turn_deg_s", s.ball_turn_deg_s, {-3600, 3600},
            "At a full twist about x, y, z, degrees a second.");
  v.numbers("tracker_axes", s.tracker_axes, {-3, 3},
            "The wall's x (right), y (up), z (towards the person) as axes of the tracker: 1 x, 2 "
            "y, 3 z, negative to turn one round.");
  v.integer("hand_station", s.hand_station, {1, 4},
            "Of the tracker, that the grabbing hand wears.");
  v.number("hand_gain", s.hand_gain, {0.01, 1000}, "Metres of the model for a metre of the hand.");
  v.number("fly_gain", s.fly_gain, {0.01, 1000},
           "Metres a second of the viewer for a metre of the hand, while it flies.");
  v.numbers("tracker_origin_m", s.tracker_origin_m, {-100, 100},
            "Where the tracker's transmitter stands as seen from the eye, for pointing: x right, y "
            "up, z towards the person, metres.");
  v.number("wall_distance_m", s.wall_distance_m, {0.1, 100},
           "From the eye to the wall, for a hand that points past the model, metres.");
  v.number("hand_noise_m", s.hand_noise_m, {0, 1},
           "Way of the hand that is taken for the tracker's noise, metres.");
  v.number("hand_noise_deg", s.hand_noise_deg, {0, 180},
           "Turn of the hand that is taken for noise, degrees.");
  v.number("still_after_s", s.still_after_s, {0.01, 10},
           "Without input until the scene counts as still, seconds.");
  v.number("posture_hold_s", s.posture_hold_s, {0, 10},
           "That a posture lasts before it acts, seconds.");
  v.number("stale_after_s", s.stale_after_s, {0.1, 10},
           "After which a device that is no longer well has let go, seconds.");
  v.number("return_after_s", s.return_after_s, {0, 86400},
           "That no tile of the wall has shown any of the content, after which the start view "
           "returns once nobody moves it, seconds; 0: never.");
  v.listOf<render::Binding>("bindings", s.bindings, "What inputs do.", [&](render::Binding& b) {
    v.text("input", b.input, "ball.button.1 to ball.button.12, posture.NAME or glove.switch.");
    v.oneOf("action", b.action, render::kActionNames,
            "While held: grab, the hand moves the model, fly, its way is the viewer's speed, "
            "point_at, it marks what it points at; the others: once.");
    v.oneOf("on", b.when, kWhen,
            "Which moment of the input: hold for what lasts, enter or leave for what is done once; "
            "by_action: hold or enter.");
  });
}

void describeRender(render::RenderSettings& r, SettingsVisitor& v) {
  v.oneOf("backend", r.gl.backend, kBackends, "Which windowless OpenGL draws.");
  v.integer("contexts", r.gl.contexts, {0, 2},
            "OpenGL contexts that share the tiles, each on a thread of its own, EGL only; 0: two "
            "for a software renderer on two cores or more, else one.");
  v.integer("raster_threads", r.gl.raster_threads, {0, 16},
            "Of Mesa's software renderer; 0: the wall's own thread does all.");
  v.text("show", r.model.show.feature,
         "The feature that is shown as colours, one value on a scale (thermal, confidence ...); "
         "empty: the model's own colours. Every content has to have it.");
  v.numbers("show_range", r.model.show.range, {-1e9, 1e9},
            "Where that scale begins and ends; twice the same: as the model's values do.");
  v.flag("view_dependent", r.model.view_dependent,
         "Triangles where the tiles look, finer near; else as many everywhere.");
  v.number("geomorph", r.model.geomorph, {0, 0.5},
           "Share of the triangles whose vertices are on their way to where they merge next, so "
           "that nothing pops; 0: vertices jump.");
  v.integer("fade_frames", r.fade_frames, {1, 30},
            "Frames in which a finer picture of what is still replaces a coarser one; 1: at once.");
  v.numbers("colour", r.model.style.colour, {0, 1},
            "Of a model without colours: red, green, blue.");
  v.numbers("background", r.model.style.background, {0, 1}, "Red, green, blue.");
  v.number("brightness", r.model.style.brightness, {0.1, 10},
           "Multiplies the model's colours; for dark scans.");
  v.flag("draw_back_faces", r.model.style.draw_back_faces,
         "For open scans that are seen from behind; costs 1.6 to 1.9 times the time.");
  v.flag("wireframe", r.model.style.wireframe, "Draws edges instead of faces.");
}

void describeGpio(GpioSettings& g, SettingsVisitor& v) {
  v.text("chip", g.chip, "gpiochip0 or /dev/gpiochip0; empty: there is no panel.");
  v.integer("projector_line", g.projector_line, {-1, 1023},
            "Line that is high while the projectors have power; -1: none.");
  v.integer("video_line", g.video_line, {-1, 1023},
            "Line that is low for video A, high for B; -1: none.");
  v.integer("lamp_line", g.lamp_line, {-1, 1023},
            "Line that is high while the lamp is lit; -1: none.");
  v.integer("button_line", g.button_line, {-1, 1023},
            "Line that is high while the button is pressed; -1: none.");
  v.number("warm_up_s", g.warm_up_s, {0, 3600}, "Until projectors show a picture, seconds.");
  v.number("cool_down_s", g.cool_down_s, {0, 3600},
           "After switching off, in which they are not switched on again, seconds.");
  v.number("interlock_s", g.interlock_s, {0, 3600}, "Between two switchings, at least, seconds.");
  v.number("debounce_s", g.debounce_s, {0, 1},
           "That the button is down before it counts, seconds.");
  v.choiceOf("button_command", g.button_command, kButtonCommands,
             "What a press of the panel's button does: a command of the wall or of the panel.");
}

void describeServe(ServeSettings& s, SettingsVisitor& v) {
  v.path("spnav_socket", s.spnav_socket,
         "The ball for programs built on libspnav, usually /run/spnav.sock; empty: none.");
  v.integer("vrpn_port", s.vrpn_port, {0, 65535},
            "Hand, tracker and ball for VRPN clients on this machine, usually 3883; 0: none.");
  v.text("samples_endpoint", s.samples_endpoint,
         "Samples for other machines' walls, encrypted: tcp://*:7401; empty: none.");
  v.path("samples_keys", s.samples_keys, "This machine's keys: merlin keys -o FILE.");
  v.path("samples_clients", s.samples_clients, "Public keys of those who may listen, one a line.");
}

void describeWall(WallSettings& w, SettingsVisitor& v) {
  v.group("input", "Another machine's devices, in place of this one's.", [&] {
    v.text("endpoint", w.input.endpoint,
           "tcp://HOST:PORT of the merlind that has them; empty: this machine's shared memory.");
    v.text("server_key", w.input.server_key, "That merlind's public key.");
    v.path("keys", w.input.keys, "This machine's keys: merlin keys -o FILE.");
  });
  v.path("model", w.model, "The multiresolution model that is shown (first), an .mrm file.");
  v.listOf<ContentSettings>("contents", w.contents, "Shown after it, in turn, by next_content.",
                            [&](ContentSettings& c) { v.path("model", c.model, "An .mrm file."); });
  v.group("rate", "The frame rate, and what is given for it.", [&] {
    v.number("rate_hz", w.governor.rate_hz, {1, 240}, "Frames a second while anything moves.");
    v.integer("min_triangles", w.governor.min_triangles, {4, 1e6},
              "Never fewer while it moves, however late.");
    v.integer("max_triangles", w.governor.max_triangles, {4, 1e9}, "Never more while it moves.");
    v.integer("first_triangles", w.governor.first_triangles, {4, 1e9},
              "Before anything was measured.");
    v.number("late_share", w.governor.late_share, {0.0001, 0.5},
             "Of frames, that the head room is learnt for.");
  });
  v.group("tiles", "The geometry of the wall.", [&] { describeTiles(w.tiles, v); });
  v.group("scene", "Where the model stands, and what a person's input does.",
          [&] { describeScene(w.scene, v); });
  v.group("render", "How it is drawn.", [&] { describeRender(w.render, v); });
  v.path("snapshots", w.snapshots,
         "The folder for the frames that the action snapshot writes; empty: none.");
  v.integer("snapshots_kept", w.snapshots_kept, {1, 1e6},
            "The number of snapshots that are kept in the folder; the oldest are removed.");
  v.listOf<render::OutputSettings>(
      "outputs", w.outputs, "Where the frames go. One that fails takes nothing with it.",
      [&](render::OutputSettings& o) {
        v.oneOf("kind", o.kind, render::kOutputKindNames,
                "shared_memory: for merlin snapshot and other programs on this machine, at most "
                "once; png: the newest frame as a file, now and then.");
        v.text("name", o.name, "The output's name in status and events; empty: its kind.");
        v.path("path", o.path, "The file that an output of kind png writes.");
        v.number("interval_s", o.interval_s, {1, 86400},
                 "The shortest time between two files of an output of kind png, in seconds.");
      });
}

}  // namespace

void describe(Settings& s, SettingsVisitor& v) {
  v.text("instance", s.instance,
         "Keeps two daemons on one machine apart: part of the names of shared memory and sockets.");
  v.path(
      "run_directory", s.run_directory,
      "Where sockets and emulators' lines lie; empty: /run/merlin for root, else the user's own.");
  v.group("devices", "What is read.", [&] {
    v.group("glove", "A CyberGlove.", [&] { describeGlove(s.devices, v); });
    v.group("tracker", "A Polhemus Fastrak.", [&] { describeTracker(s.devices, v); });
    v.group("ball", "A Spaceball.", [&] { describeBall(s.devices, v); });
    v.group("hand", "Glove and tracker as one hand.", [&] {
      v.integer("station", s.devices.hand.station, {1, 4}, "Of the tracker, that the hand wears.");
      v.number(
          "cutoff_hz", s.devices.hand.cutoff_hz, {0, 100},
          "Of the smoothing of a hand at rest; it adds a delay of 1 / (2 pi cut-off); 0: none.");
      v.number("cutoff_per_m_s", s.devices.hand.cutoff_per_m_s, {0, 1000},
               "By which the cut-off rises with the hand's speed, Hz for a metre a second.");
    });
    v.group("gpio", "The wall's control panel on a GPIO chip.",
            [&] { describeGpio(s.devices.gpio, v); });
    v.path("postures", s.devices.postures,
           "The posture network, a JSON file; empty: no posture is recognised.");
    v.number("posture_hold_s", s.devices.posture_hold.hold_s, {0, 10},
             "That a posture lasts before it counts, seconds.");
    v.number("posture_leave_s", s.devices.posture_hold.leave_s, {0, 10},
             "That a posture is gone before it ends, seconds.");
    v.number("posture_margin", s.devices.posture_hold.least_margin, {0, 1},
             "Less sure than this, a hand shows no posture; half of it keeps the one that is "
             "held.");
    v.integer(
        "cpu_latency_us", s.devices.cpu_latency_us, {-1, 10000},
        "Within which idle cores wake for a byte, microseconds: 0 keeps them all awake, which "
        "costs power; -1: as the system has it.");
    v.choiceOf("script", s.devices.script, kScripts,
               "What the emulated person does, with --emulate.");
  });
  v.group("wall", "What is shown.", [&] { describeWall(s.wall, v); });
  v.group("serve", "Servers for other programs and machines.", [&] { describeServe(s.serve, v); });
}

}  // namespace merlin
