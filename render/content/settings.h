// Settings of how contents are drawn.
#pragma once

#include <array>
#include <string>

namespace merlin::render {

struct RenderStyle {
  std::array<float, 3> colour{0.75F, 0.75F, 0.72F};  // of a model without vertex colours, 0..1
  std::array<float, 3> background{0.06F, 0.07F, 0.09F};
  float brightness = 1;          // multiplies colours before they are clipped; for dark scans
  bool draw_back_faces = false;  // lit as fronts; costs 1.6 to 1.9 times the time
  bool wireframe = false;
};

// Which of a model's features its colours show.
struct ShownFeature {
  std::string feature{};         // empty: the model's own colours
  std::array<float, 2> range{};  // feature values at the two ends of the colour scale; equal: the
                                 // model's own range
};

// How a model is drawn.
struct ModelSettings {
  ShownFeature show{};
  bool view_dependent = true;  // triangles where the tiles look; else as many everywhere
  double geomorph = 0.125;     // share of a cut's triangles that are on their way to the next
  RenderStyle style{};
};

}  // namespace merlin::render
