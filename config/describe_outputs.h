// The part of describe() that is /wall/outputs.
#pragma once

#include <vector>

#include "config/visitor.h"
#include "render/out/settings.h"

namespace merlin {

void describeOutputs(std::vector<render::out::OutputSettings>& outputs, SettingsVisitor& visitor);

}  // namespace merlin
