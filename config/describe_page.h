// The part of describe() that is /page, the operator's web page.
#pragma once

#include "config/visitor.h"
#include "daemon/page/settings.h"

namespace merlin {

void describePage(PageSettings& page, SettingsVisitor& visitor);

}  // namespace merlin
