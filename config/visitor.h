// describe(): the only description of all settings, for any SettingsVisitor.
#pragma once

#include "daemon/base/settings_visitor.h"

namespace merlin {

struct Settings;

// Calls `visitor` for every setting of `settings`, always in the same order: that of written files.
void describe(Settings& settings, SettingsVisitor& visitor);

}  // namespace merlin
