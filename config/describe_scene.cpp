#include "config/describe_scene.h"

namespace merlin {
namespace {

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
          "Where corrections of outputs are computed: on the cpu, or by a shader (gpu), which runs "
          "in software where no GPU draws. auto: by a shader if a GPU draws, otherwise on the "
          "CPU.");
  v.oneOf(
      "scan_out", r.scan_out, render::frame::kScanOutNames,
      "How signals that the GPU corrects come to displays of kind kms. auto: the GPU draws them "
      "into the memory that the display shows, if it is the display's own GPU and its driver "
      "can do so; otherwise they are read back and copied there. copied: always read back and "
      "copied.");
  v.integer("raster_threads", r.gl.raster_threads, {0, 16},
            "Number of rasterizer threads of Mesa's software renderer; 0: the drawing thread "
            "itself rasterizes.");
}

}  // namespace

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

void describeRender(render::frame::RenderSettings& r, SettingsVisitor& v) {
  describeRenderer(r, v);
  v.text("show", r.model.show.feature,
         "Name of the vertex feature that the model's colours show (thermal, confidence ...); a "
         "feature with one value per vertex is shown on a colour scale. Every model must have this "
         "feature. Empty: the model's own colours.");
  v.numbers("show_range", r.model.show.range, {-1e9, 1e9},
            "Values of the feature named by show at the first and last colour of the scale. Two "
            "equal numbers: from the 1st to the 99th percentile of the model's values.");
  v.flag("view_dependent", r.model.view_dependent,
         "Whether the resolution of the model depends on the view: most triangles are in the parts "
         "of the model that the tiles show, and more densely near the eye. Otherwise the "
         "resolution is uniform.");
  v.number("geomorph", r.model.geomorph, {0, 0.5},
           "Share of the triangles whose vertices move gradually to the position where they will "
           "merge (geomorphs), so that a change of detail is not visible as a jump. 0: vertices "
           "jump.");
  v.integer("picture_memory_mb", r.picture_memory_mb, {0, 65'536},
            "Maximum memory for the tiles of the image pyramid that is shown, in MiB: in main "
            "memory and in the textures of all drawing contexts together. 0: the memory that full "
            "detail takes on this wall, but at least 192. With less memory than that, pictures are "
            "shown in less detail.");
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

}  // namespace merlin
