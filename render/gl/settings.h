// What the configuration says of drawing.
#pragma once

#include <array>
#include <string>

namespace merlin::render {

enum class GlBackend { kEgl, kOsmesa };

struct Look {
  std::array<float, 3> colour{0.75F, 0.75F, 0.72F};  // of a model without vertex colours, 0..1
  std::array<float, 3> background{0.06F, 0.07F, 0.09F};
  float brightness = 1;          // multiplies colours before they are clipped; for dark scans
  bool draw_back_faces = false;  // lit as fronts; costs 1.6 to 1.9 times the time
  bool wireframe = false;
};

// What is shown as colours.
struct Shown {
  std::string feature{};         // empty: the model's own colours
  std::array<float, 2> range{};  // of one value, where the scale begins and ends; equal: where the
                                 // model's values do
};

struct RenderSettings {
  GlBackend backend = GlBackend::kEgl;
  int contexts = 0;        // that share the tiles, each on a thread of its own; 0: two where a
                           // software renderer and a second core make that worth it
  int raster_threads = 0;  // of Mesa's software renderer; 0: the wall's own thread does all
  Shown show{};
  bool view_dependent = true;  // triangles where the tiles look; else as many everywhere
  double geomorph = 0.125;     // share of a cut's triangles that are on their way to the next
  int fade_frames = 3;         // in which a finer picture of what is still replaces a coarser
  Look look;
};

}  // namespace merlin::render
