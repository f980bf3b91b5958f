// describe(): presents all settings to a SettingsVisitor. It is the only description of the
// settings.
#pragma once

#include "daemon/base/settings_visitor.h"

namespace merlin {

struct Settings;

// Calls `visitor` for every setting of `settings`, always in the same order, which is that of
// written configurations.
void describe(Settings& settings, SettingsVisitor& visitor);

}  // namespace merlin
