// DrawContexts: the OpenGL contexts that share a frame's tiles.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "render/frame/draw_thread.h"
#include "render/gl/gl_context.h"
#include "render/gl/settings.h"

namespace merlin::render {

// The context of the thread that made it and, where there is one, a second one on a thread of its
// own. Thread-bound; shared by the renderers of all contents, of which the last one ends it.
struct DrawContexts {
  std::unique_ptr<GlContext> own;
  std::unique_ptr<DrawThread> other;

  // Current on this thread. Errors: kUnsupported (no GL of that kind, or not enough contexts).
  static Result<std::shared_ptr<DrawContexts>> make(const GlSettings& settings);

  std::string renderer() const;  // for a person
};

}  // namespace merlin::render
