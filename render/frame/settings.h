// Settings of drawing frames.
#pragma once

#include "render/content/settings.h"
#include "render/gl/settings.h"

namespace merlin::render::frame {

// Where outputs' corrections are computed. In the order of kCorrectionPlaceNames.
enum class CorrectionPlace { kAuto, kCpu, kGpu };  // kAuto: where frames are drawn
inline constexpr const char* kCorrectionPlaceNames[] = {"auto", "cpu", "gpu"};

// How a signal that a shader has computed reaches the displays of an output of kind kms. In the
// order of kScanOutNames.
enum class ScanOutMode {
  kAuto,    // drawn into the memory that the display shows, where a GPU can do so
  kCopied,  // read back and copied
};
inline constexpr const char* kScanOutNames[] = {"auto", "copied"};

struct RenderSettings {
  gl::GlSettings gl{};
  content::ModelSettings model{};
  CorrectionPlace correction = CorrectionPlace::kAuto;
  ScanOutMode scan_out = ScanOutMode::kAuto;
  // [MB] for the tiles of pictures, in memory and in textures; 0: by the wall's size.
  int picture_memory_mb = 0;
  int fade_frames = 3;  // duration of the fade to a finer frame of a still scene
};

}  // namespace merlin::render::frame
