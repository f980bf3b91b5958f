#include "render/gl/egl_import.h"

#include <cstdint>
#include <string_view>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

namespace merlin::render::gl {
namespace {

// Type of glEGLImageTargetRenderbufferStorageOES() of GL_OES_EGL_image, which glcorearb.h lacks.
using TakeImage = void (*)(GLenum target, void* image);

bool offers(EGLDisplay display, std::string_view extension) {
  const char* const all = eglQueryString(display, EGL_EXTENSIONS);
  const std::string padded = fmt::format(" {} ", all ? all : "");
  return padded.find(fmt::format(" {} ", extension)) != std::string::npos;
}

// Returns whether the driver lists modifiers for this pixel format. A driver that lists none takes
// the memory's layout from its kernel driver.
bool knowsModifiers(EGLDisplay display, std::uint32_t format) {
  if (!offers(display, "EGL_EXT_image_dma_buf_import_modifiers")) return false;
  const auto query = reinterpret_cast<PFNEGLQUERYDMABUFMODIFIERSEXTPROC>(
      eglGetProcAddress("eglQueryDmaBufModifiersEXT"));
  EGLint count = 0;
  return query && query(display, static_cast<EGLint>(format), 0, nullptr, nullptr, &count) &&
         count > 0;
}

EGLImageKHR makeImage(EGLDisplay display, const DmaBuf& buffer, bool with_modifier) {
  const auto create =
      reinterpret_cast<PFNEGLCREATEIMAGEKHRPROC>(eglGetProcAddress("eglCreateImageKHR"));
  if (!create) return EGL_NO_IMAGE_KHR;
  std::vector<EGLint> attributes = {EGL_WIDTH,
                                    buffer.width,
                                    EGL_HEIGHT,
                                    buffer.height,
                                    EGL_LINUX_DRM_FOURCC_EXT,
                                    static_cast<EGLint>(buffer.format),
                                    EGL_DMA_BUF_PLANE0_FD_EXT,
                                    buffer.file.get(),
                                    EGL_DMA_BUF_PLANE0_OFFSET_EXT,
                                    static_cast<EGLint>(buffer.offset),
                                    EGL_DMA_BUF_PLANE0_PITCH_EXT,
                                    static_cast<EGLint>(buffer.pitch)};
  if (with_modifier) {
    attributes.push_back(EGL_DMA_BUF_PLANE0_MODIFIER_LO_EXT);
    attributes.push_back(static_cast<EGLint>(buffer.modifier & 0xFFFFFFFFU));
    attributes.push_back(EGL_DMA_BUF_PLANE0_MODIFIER_HI_EXT);
    attributes.push_back(static_cast<EGLint>(buffer.modifier >> 32U));
  }
  attributes.push_back(EGL_NONE);
  return create(display, EGL_NO_CONTEXT, EGL_LINUX_DMA_BUF_EXT, nullptr, attributes.data());
}

Error refused(const char* step, const DmaBuf& buffer, unsigned error) {
  return {Errc::kUnsupported,
          fmt::format("the driver does not draw into a display's memory of {} x {} pixels: {}: "
                      "error 0x{:04X}",
                      buffer.width, buffer.height, step, error)};
}

}  // namespace

Result<RenderTarget> importTarget(void* display, const GlApi& gl, const DmaBuf& buffer) {
  const auto take =
      reinterpret_cast<TakeImage>(eglGetProcAddress("glEGLImageTargetRenderbufferStorageOES"));
  const auto destroy =
      reinterpret_cast<PFNEGLDESTROYIMAGEKHRPROC>(eglGetProcAddress("eglDestroyImageKHR"));
  if (!take || !destroy || !offers(display, "EGL_EXT_image_dma_buf_import"))
    return Error{Errc::kUnsupported, "the driver lacks EGL_EXT_image_dma_buf_import"};
  // If the driver refuses the modifier, the import is not tried without it: the driver could then
  // take linear rows for tiles.
  const EGLImageKHR image = makeImage(display, buffer, knowsModifiers(display, buffer.format));
  if (image == EGL_NO_IMAGE_KHR)
    return refused("eglCreateImage", buffer, static_cast<unsigned>(eglGetError()));
  while (gl.GetError() != GL_NO_ERROR) continue;
  GLuint renderbuffer = 0;
  gl.GenRenderbuffers(1, &renderbuffer);
  gl.BindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
  take(GL_RENDERBUFFER, image);
  destroy(display, image);  // the renderbuffer keeps the memory
  auto target = RenderTarget::makeOf(gl, renderbuffer, buffer.width, buffer.height);
  const GLenum error = gl.GetError();
  if (error != GL_NO_ERROR) return refused("glEGLImageTargetRenderbufferStorage", buffer, error);
  return target;
}

}  // namespace merlin::render::gl
