// Settings of OpenGL.
#pragma once

namespace merlin::render::gl {

enum class GlBackend { kEgl, kOsmesa };

struct GlSettings {
  GlBackend backend = GlBackend::kEgl;
  // Number of contexts that share the tiles, each on its own thread; 0: two for Mesa's software
  // renderer on more than one core, else one.
  int contexts = 0;
  int raster_threads = 0;  // of Mesa's software renderer; 0: it rasterises on the calling thread
};

}  // namespace merlin::render::gl
