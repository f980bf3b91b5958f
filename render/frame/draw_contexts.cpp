#include "render/frame/draw_contexts.h"

#include <thread>

namespace merlin::render::frame {
namespace {

// llvmpipe draws vertices in the calling thread, so a second context makes use of a second core; a
// GPU would only switch between the two.
bool takesTwo(const gl::GlSettings& settings, bool software) {
  if (settings.contexts > 0) return settings.contexts > 1;
  return software && std::thread::hardware_concurrency() > 1;
}

}  // namespace

Result<std::shared_ptr<DrawContexts>> DrawContexts::make(const gl::GlSettings& settings) {
  auto contexts = std::make_shared<DrawContexts>();
  auto own = gl::makeGlContext(settings.backend, settings.gpu);
  if (!own) return own.error();
  contexts->own = *std::move(own);
  const bool software = contexts->own->info().software;
  contexts->asynchronous = settings.read_back == gl::ReadBackMode::kAsynchronous ||
                           (settings.read_back == gl::ReadBackMode::kAuto && !software);
  if (!takesTwo(settings, software)) return contexts;
  auto other = DrawThread::make(*contexts->own);
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
