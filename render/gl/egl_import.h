// Imports memory of a graphics card into a context of EGL (EGL_EXT_image_dma_buf_import). Private
// to render/gl.
#pragma once

#include "daemon/base/dma_buf.h"
#include "daemon/base/result.h"
#include "render/gl/gl_api.h"
#include "render/gl/render_target.h"

namespace merlin::render::gl {

// Makes a render target of the memory `buffer`. `display`: the EGLDisplay of the current context,
// whose functions are `gl`. Does not check to which device the memory belongs. Errors:
// kUnsupported: what the driver lacks or refuses.
Result<RenderTarget> importTarget(void* display, const GlApi& gl, const DmaBuf& buffer);

}  // namespace merlin::render::gl
