// Settings of OpenGL.
#pragma once

#include <string>

namespace merlin::render::gl {

enum class GlBackend { kEgl, kOsmesa };
inline constexpr const char* kGlBackendNames[] = {"egl", "osmesa"};

// How a frame's pixels come from OpenGL into memory. In the order of kReadBackNames.
enum class ReadBackMode {
  kAuto,          // asynchronously from a GPU, directly from a software renderer
  kDirect,        // each tile as soon as it is drawn; waits until its drawing has finished
  kAsynchronous,  // through pixel buffers that are filled while other tiles are drawn
};
inline constexpr const char* kReadBackNames[] = {"auto", "direct", "asynchronous"};

// Values of GlSettings::gpu beside those that name a GPU.
inline constexpr const char* kAnyGpu = "auto";
inline constexpr const char* kNoGpu = "none";

struct GlSettings {
  GlBackend backend = GlBackend::kEgl;
  // Number of contexts that share the tiles, each on its own thread; 0: two for Mesa's software
  // renderer on more than one core, else one.
  int contexts = 0;
  // Threads of Mesa's software renderer; 0: it rasterises on the calling thread.
  int raster_threads = 0;
  // What draws: kAnyGpu, kNoGpu (software), or a GPU as chooseGpu() finds it.
  std::string gpu = kAnyGpu;
  ReadBackMode read_back = ReadBackMode::kAuto;
};

}  // namespace merlin::render::gl
