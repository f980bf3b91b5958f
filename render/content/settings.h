// Settings of how contents are drawn.
#pragma once

#include <array>
#include <string>

namespace merlin::render::content {

struct RenderStyle {
  std::array<float, 3> colour{0.75F, 0.75F, 0.72F};  // RGB of a model without vertex colours, 0..1
  std::array<float, 3> background{0.06F, 0.07F, 0.09F};
  float brightness = 1;          // factor of all colours, before clipping; for dark scans
  bool draw_back_faces = false;  // draws back faces too, weakly lit; takes 1.6 to 1.9 times as long
  bool wireframe = false;
};

// The feature of a model that is shown as colours.
struct ShownFeature {
  std::string feature{};         // empty: the model's own colours
  std::array<float, 2> range{};  // feature values at the two ends of the colour scale; if equal:
                                 // 1st and 99th percentile of the model
};

// Which kind of picture a pyramid is shown as. In the order of kShowAsNames.
enum class ShowAs { kAsMarked, kPlane, kPanorama };
inline constexpr const char* kShowAsNames[] = {"marked", "plane", "panorama"};

// How a model is drawn.
struct ModelSettings {
  ShownFeature show{};
  bool view_dependent = true;  // finer where tiles show the model closer; else uniform detail
  double geomorph = 0.125;     // share of the triangles that morph to the next coarser level
  RenderStyle style{};
};

}  // namespace merlin::render::content
