// The part of describe() (config/visitor.h) that covers /wall/outputs.
#pragma once

#include <vector>

#include "config/visitor.h"
#include "render/out/settings.h"

namespace merlin {

void describeOutputs(std::vector<render::out::OutputSettings>& outputs, SettingsVisitor& visitor);

}  // namespace merlin
