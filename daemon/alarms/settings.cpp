#include "daemon/alarms/settings.h"

#include <algorithm>

#include <fmt/format.h>

#include "daemon/base/event_kinds.h"

namespace merlin {
namespace {

std::string kindNames() {
  std::vector<std::string> names;
  for (const EventKind& kind : kEventKinds) names.emplace_back(kind.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

bool isKind(const std::string& name) {
  return std::ranges::any_of(kEventKinds, [&](const EventKind& kind) { return name == kind.name; });
}

}  // namespace

SettingFaults validate(const std::vector<AlarmSettings>& alarms) {
  SettingFaults faults;
  for (std::size_t i = 0; i < alarms.size(); ++i) {
    const AlarmSettings& alarm = alarms[i];
    if (alarm.run.empty()) {
      faults.push_back({fmt::format("/{}/run", i),
                        "names no program; it needs one, as an absolute path, and its arguments"});
    } else if (!alarm.run.front().starts_with('/')) {
      faults.push_back(
          {fmt::format("/{}/run/0", i),
           fmt::format("is \"{}\"; a program is named by an absolute path", alarm.run.front())});
    }
    for (std::size_t k = 0; k < alarm.kinds.size(); ++k) {
      if (isKind(alarm.kinds[k])) continue;
      faults.push_back(
          {fmt::format("/{}/kinds/{}", i, k),
           fmt::format("is \"{}\"; kinds of events are {}", alarm.kinds[k], kindNames())});
    }
  }
  return faults;
}

}  // namespace merlin
