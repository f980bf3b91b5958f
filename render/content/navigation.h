// How a person moves a content, or moves within it.
#pragma once

namespace merlin::render::content {

enum class Navigation {
  kObject,    // a model: it is turned and moved, or the viewer moves around it
  kPlane,     // an image: it is moved in its plane and zoomed
  kPanorama,  // a panorama: the viewer looks around from its centre, and zooms
};

// Least distance between viewer and plane, as a multiple of the initial one, unless the content
// defines another.
inline constexpr float kNearestPlane = 0.02F;

}  // namespace merlin::render::content
