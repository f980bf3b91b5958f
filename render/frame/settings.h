// Settings of drawing frames.
#pragma once

#include "render/content/settings.h"
#include "render/gl/settings.h"

namespace merlin::render::frame {

struct RenderSettings {
  gl::GlSettings gl{};
  content::ModelSettings model{};
  int fade_frames = 3;  // duration of the fade to a finer frame of a still scene
};

}  // namespace merlin::render::frame
