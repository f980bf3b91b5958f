// GlContext: an OpenGL 3.3 core context without a window, current on the thread that created it.
//
// The default is EGL, on a GPU or with Mesa's software renderer. The alternative is OSMesa, which
// Mesa dropped in 25.1, so it may be absent. Both draw only into frame buffer objects.
// Thread-bound.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/dma_buf.h"
#include "daemon/base/result.h"
#include "render/gl/gl_api.h"
#include "render/gl/render_target.h"
#include "render/gl/renderer_info.h"
#include "render/gl/settings.h"

namespace merlin::render::gl {

class GlContext {
 public:
  virtual ~GlContext() = default;

  const GlApi& gl() const noexcept { return api_; }
  const RendererInfo& info() const noexcept { return info_; }
  // Names library and device for a person: "EGL, llvmpipe (LLVM 15.0.6, 256 bits)".
  std::string renderer() const { return info_.library + ", " + info_.name; }

  // Returns whether the driver has reset the GPU: the context and all that it holds are then lost,
  // and frames stay black. Stays true, since some drivers report a reset only once. False if the
  // driver does not report resets.
  bool wasReset() const {
    if (!was_reset_ && api_.GetGraphicsResetStatus)
      was_reset_ = api_.GetGraphicsResetStatus() != GL_NO_ERROR;
    return was_reset_;
  }

  // Creates another context by the same renderer, current on the calling thread, which must be
  // another one than this context's. Mesa's software renderer draws the contexts of one EGL display
  // one after the other, so its further context gets another display if one is available. Errors:
  // kUnsupported.
  virtual Result<std::unique_ptr<GlContext>> makeFurther() const = 0;

  // Makes a render target of memory that a display can show, so that what is drawn need not be
  // copied to it. The target keeps the memory. Errors: kUnsupported: why this context cannot draw
  // there, e.g. since the memory is another device's.
  virtual Result<RenderTarget> importTarget(const DmaBuf& buffer) const;

 protected:
  GlApi api_;
  RendererInfo info_;

 private:
  mutable bool was_reset_ = false;
};

// Creates a context that is current on the calling thread. `gpu`: as GlSettings::gpu; kAnyGpu takes
// the first GPU on which a context can be created, else the software renderer. Errors:
// kUnsupported, with what is missing (the library, the context or an OpenGL function);
// kInvalidArgument (`gpu` names no GPU of this machine, or OSMesa was asked for a GPU).
Result<std::unique_ptr<GlContext>> makeGlContext(GlBackend backend,
                                                 const std::string& gpu = kAnyGpu);

// Checks that makeGlContext() would find this GPU. Cheap for kAnyGpu and kNoGpu; otherwise it takes
// as long as listGpus(). Errors: kInvalidArgument, as for makeGlContext().
Result<Ok> checkGpu(GlBackend backend, const std::string& gpu);

// Prepares the process for Mesa's software renderer: sets the number of its raster threads (0: it
// rasterises on the calling thread), and makes the heap keep memory that one frame frees for the
// next frame. `only`: Mesa's GPU drivers are not used. Call once, before the first context is
// created and before any thread starts.
void prepareSoftwareGl(int raster_threads, bool only = false);

}  // namespace merlin::render::gl
