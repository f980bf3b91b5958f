// Settings of OpenGL.
#pragma once

namespace merlin::render {

enum class GlBackend { kEgl, kOsmesa };

struct GlSettings {
  GlBackend backend = GlBackend::kEgl;
  int contexts = 0;        // that share the tiles, each on a thread of its own; 0: two where a
                           // software renderer and a second core make that worth it
  int raster_threads = 0;  // of Mesa's software renderer; 0: the wall's own thread does all
};

}  // namespace merlin::render
