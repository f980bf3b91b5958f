// The parts of describe() (config/visitor.h) that cover /wall/scene and /wall/render.
#pragma once

#include "config/visitor.h"
#include "render/frame/settings.h"
#include "render/scene/settings.h"

namespace merlin {

void describeScene(render::scene::SceneSettings& scene, SettingsVisitor& visitor);
void describeRender(render::frame::RenderSettings& render, SettingsVisitor& visitor);

}  // namespace merlin
