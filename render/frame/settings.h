// Settings of how frames are drawn.
#pragma once

#include "render/content/settings.h"
#include "render/gl/settings.h"

namespace merlin::render {

struct RenderSettings {
  GlSettings gl{};
  ModelSettings model{};
  int fade_frames = 3;  // in which a finer frame of what is still replaces a coarser one
};

}  // namespace merlin::render
