// The parts of describe() (config/visitor.h) that cover /page (the operator's web page) and
// /alarms.
#pragma once

#include "config/visitor.h"
#include "daemon/alarms/settings.h"
#include "daemon/page/settings.h"

namespace merlin {

void describePage(PageSettings& page, SettingsVisitor& visitor);
void describeAlarm(AlarmSettings& alarm, SettingsVisitor& visitor);

}  // namespace merlin
