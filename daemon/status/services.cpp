#include "daemon/status/services.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "daemon/status/add_member.h"

namespace merlin::status {

void Services::set(const std::string& service, std::string reason) {
  const std::lock_guard lock(mutex_);
  auto found = std::find_if(services_.begin(), services_.end(),
                            [&](const Service& s) { return s.name == service; });
  const bool fresh = found == services_.end();
  if (fresh) found = services_.insert(found, {service, {}});
  if (found->reason == reason) return;
  events_.push_back(reason.empty() ? newsEvent(fmt::format("{}: works again", service))
                                   : faultEvent(fmt::format("{}: failed ({})", service, reason)));
  found->reason = std::move(reason);
}

std::vector<Event> Services::takeEvents() {
  const std::lock_guard lock(mutex_);
  return std::exchange(events_, {});
}

std::string Services::addTo(const std::string& document) const {
  nlohmann::ordered_json services;
  {
    const std::lock_guard lock(mutex_);
    for (const Service& s : services_) {
      services[s.name]["health"] = s.reason.empty() ? "ok" : "failed";
      services[s.name]["reason"] = s.reason;
    }
  }
  return addMember(document, "services", std::move(services));
}

}  // namespace merlin::status
