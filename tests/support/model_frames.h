// A model's frame renderer in one call.
#pragma once

#include <memory>
#include <utility>

#include "render/content/model_content.h"
#include "render/frame/frame_renderer.h"
#include "render/frame/settings.h"

namespace merlin::test {

// `contexts`: another renderer's, to be drawn in as well; none: some of its own. Model, plan and
// clock are borrowed.
inline Result<std::unique_ptr<render::FrameRenderer>> rendererOf(
    const render::Dendrogram& model, const render::TilePlan& plan,
    const render::RenderSettings& settings, double radius_m, const Clock& clock,
    std::shared_ptr<const render::DrawContexts> contexts = nullptr) {
  if (!contexts) {
    auto made = render::DrawContexts::make(settings.gl);
    if (!made) return made.error();
    contexts = *std::move(made);
  }
  auto content = render::ModelContent::make(model, settings.model, radius_m);
  if (!content) return content.error();
  return render::FrameRenderer::make(*std::move(content), plan, std::move(contexts), clock);
}

}  // namespace merlin::test
