// GlContext: an OpenGL 3.3 core context without a window, current on the thread that created it.
//
// The default is surfaceless EGL. The alternative is OSMesa, which Mesa dropped in 25.1, so it may
// be absent. Both draw only into frame buffer objects. Thread-bound.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "render/gl/gl_api.h"
#include "render/gl/settings.h"

namespace merlin::render::gl {

class GlContext {
 public:
  virtual ~GlContext() = default;

  const GlApi& gl() const noexcept { return api_; }
  // "EGL" or "OSMesa", and GL_RENDERER; for a person.
  const std::string& renderer() const noexcept { return renderer_; }

 protected:
  GlApi api_;
  std::string renderer_;
};

// The EGL display on which a context is created. Mesa's software renderers of one display draw one
// after the other, so two contexts that draw in parallel need two displays.
enum class EglDisplay { kSurfaceless, kDevice };

// Errors: kUnsupported, with what is missing (the library, the context or an OpenGL function).
// `display` is ignored for OSMesa.
Result<std::unique_ptr<GlContext>> makeGlContext(GlBackend backend,
                                                 EglDisplay display = EglDisplay::kSurfaceless);

// Prepares the process for Mesa's software renderer: sets the number of its raster threads (0: it
// rasterises on the calling thread), and makes the heap keep memory that one frame frees for the
// next frame. Call once, before the first context is created and before any thread starts.
void prepareSoftwareGl(int raster_threads);

}  // namespace merlin::render::gl
