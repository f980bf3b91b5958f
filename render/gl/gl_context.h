// GlContext: a windowless OpenGL 3.3 core context, current on the thread that made it.
//
// EGL surfaceless is the default; OSMesa the other (Mesa dropped it in 25.1, so it may be absent).
// Both draw into frame buffer objects only. Thread-bound.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "render/gl/gl_api.h"
#include "render/gl/settings.h"

namespace merlin::render {

class GlContext {
 public:
  virtual ~GlContext() = default;

  const GlApi& gl() const noexcept { return api_; }
  const std::string& renderer() const noexcept { return renderer_; }  // GL_RENDERER, for a person

 protected:
  GlApi api_;
  std::string renderer_;
};

// Where an EGL context is. Mesa's software renderers draw one after the other on one display.
enum class EglDisplay { kSurfaceless, kDevice };

// Errors: kUnsupported, saying what is missing (no library, no such context, a missing function).
Result<std::unique_ptr<GlContext>> makeGlContext(GlBackend backend,
                                                 EglDisplay display = EglDisplay::kSurfaceless);

// Settings of Mesa's software renderer that have to stand before the first context is made: how
// many raster threads (0: none but the caller's), and a heap that keeps what a frame frees, for the
// next. Call once, before any thread starts.
void prepareSoftwareGl(int raster_threads);

}  // namespace merlin::render
