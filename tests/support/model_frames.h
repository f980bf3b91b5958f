// Makes a frame renderer for one model in a single call.
#pragma once

#include <memory>
#include <utility>

#include "render/content/model_content.h"
#include "render/frame/frame_renderer.h"
#include "render/frame/settings.h"

namespace merlin::test {

// Makes the renderer. `contexts` may be shared with another renderer; if null, new ones are made.
// `model`, `plan` and `clock` must outlive the renderer. Errors: those of making contexts or
// renderer.
inline Result<std::unique_ptr<render::frame::FrameRenderer>> rendererOf(
    const render::lod::Dendrogram& model, const render::tiles::TilePlan& plan,
    const render::frame::RenderSettings& settings, double radius_m, const Clock& clock,
    std::shared_ptr<const render::frame::DrawContexts> contexts = nullptr) {
  if (!contexts) {
    auto made = render::frame::DrawContexts::make(settings.gl);
    if (!made) return made.error();
    contexts = *std::move(made);
  }
  auto content = render::content::ModelContent::make(model, settings.model, radius_m);
  if (!content) return content.error();
  return render::frame::FrameRenderer::make(*std::move(content), plan, std::move(contexts), clock);
}

}  // namespace merlin::test
