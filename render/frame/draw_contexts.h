// DrawContexts: the OpenGL contexts that draw a frame's tiles.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "render/frame/draw_thread.h"
#include "render/gl/gl_context.h"
#include "render/gl/settings.h"

namespace merlin::render::frame {

// A context on the thread that called make() and, optionally, a second one on its own thread (null
// if there is none). Thread-bound; shared by the renderers of all contents: the last one destroys
// it.
struct DrawContexts {
  std::unique_ptr<gl::GlContext> own;
  std::unique_ptr<DrawThread> other;
  bool asynchronous = false;  // pixel read-back is asynchronous: see gl::ReadBackMode

  // Creates the contexts; `own` is current on the calling thread. Errors: those of makeGlContext();
  // kUnsupported (fewer contexts can be created than are configured).
  static Result<std::shared_ptr<DrawContexts>> make(const gl::GlSettings& settings);

  std::string renderer() const;  // name of the renderer, for a person
};

}  // namespace merlin::render::frame
