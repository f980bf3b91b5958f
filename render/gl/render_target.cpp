#include "render/gl/render_target.h"

#include <cassert>
#include <utility>

#include <fmt/format.h>

namespace merlin::render::gl {

Result<RenderTarget> RenderTarget::make(const GlApi& gl, int width, int height, Depth depth) {
  RenderTarget f(gl, width, height);
  gl.GenFramebuffers(1, &f.frame_);
  gl.GenRenderbuffers(1, &f.colour_);
  gl.BindRenderbuffer(GL_RENDERBUFFER, f.colour_);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  f.bind();
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, f.colour_);
  if (depth == Depth::k24Bits) {
    gl.GenRenderbuffers(1, &f.depth_);
    gl.BindRenderbuffer(GL_RENDERBUFFER, f.depth_);
    gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, f.depth_);
  }
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return f;
  return Error{
      Errc::kUnsupported,
      fmt::format("OpenGL cannot create a render target of {} x {} pixels: status 0x{:04X}", width,
                  height, status)};
}

Result<RenderTarget> RenderTarget::makeOf(const GlApi& gl, GLuint renderbuffer, int width,
                                          int height) {
  RenderTarget f(gl, width, height);
  f.colour_ = renderbuffer;
  gl.GenFramebuffers(1, &f.frame_);
  f.bind();
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, f.colour_);
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return f;
  return Error{Errc::kUnsupported,
               fmt::format("OpenGL cannot draw into this memory: status 0x{:04X}", status)};
}

RenderTarget::RenderTarget(RenderTarget&& other) noexcept
    : gl_(other.gl_),
      width_(other.width_),
      height_(other.height_),
      frame_(std::exchange(other.frame_, 0)),
      colour_(std::exchange(other.colour_, 0)),
      depth_(std::exchange(other.depth_, 0)) {}

RenderTarget::~RenderTarget() {
  if (frame_ == 0) return;
  gl_->DeleteFramebuffers(1, &frame_);
  gl_->DeleteRenderbuffers(1, &colour_);
  gl_->DeleteRenderbuffers(1, &depth_);
}

void RenderTarget::bind() const { gl_->BindFramebuffer(GL_FRAMEBUFFER, frame_); }

void RenderTarget::read(std::uint8_t* pixels, int stride_px, int width, int height) const {
  assert(width <= width_ && height <= height_ && stride_px >= width);
  bind();
  gl_->PixelStorei(GL_PACK_ROW_LENGTH, stride_px);
  gl_->ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
}

}  // namespace merlin::render::gl
