// Settings of drawing frames.
#pragma once

#include "render/content/settings.h"
#include "render/gl/settings.h"

namespace merlin::render::frame {

// Where outputs' corrections are computed. In the order of kCorrectionPlaceNames.
enum class CorrectionPlace { kAuto, kCpu, kGpu };  // kAuto: where frames are drawn
inline constexpr const char* kCorrectionPlaceNames[] = {"auto", "cpu", "gpu"};

struct RenderSettings {
  gl::GlSettings gl{};
  content::ModelSettings model{};
  CorrectionPlace correction = CorrectionPlace::kAuto;
  int picture_memory_mb = 0;  // for picture tiles, in memory and textures; 0: from the wall's size
  int fade_frames = 3;        // duration of the fade to a finer frame of a still scene
};

}  // namespace merlin::render::frame
