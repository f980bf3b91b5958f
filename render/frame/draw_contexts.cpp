#include "render/frame/draw_contexts.h"

#include <thread>

namespace merlin::render::frame {

Result<std::shared_ptr<DrawContexts>> DrawContexts::make(const gl::GlSettings& settings) {
  auto contexts = std::make_shared<DrawContexts>();
  auto own = gl::makeGlContext(settings.backend);
  if (!own) return own.error();
  contexts->own = *std::move(own);
  if (settings.contexts == 1) return contexts;
  const bool software = contexts->own->renderer().find("llvmpipe") != std::string::npos;
  const bool pays = software && std::thread::hardware_concurrency() > 1;
  if (settings.contexts == 0 && !pays) return contexts;
  auto other = settings.backend == gl::GlBackend::kEgl
                   ? DrawThread::make()
                   : Error{Errc::kUnsupported,
                           "render.contexts: OSMesa has only one context in a process; "
                           "set it to 1, or render.backend to egl"};
  if (other)
    contexts->other = *std::move(other);
  else if (settings.contexts > 1)
    return other.error();
  return contexts;
}

std::string DrawContexts::renderer() const {
  return own->renderer() + (other ? ", two contexts" : "");
}

}  // namespace merlin::render::frame
