#include "daemon/status/projectors.h"

#include <ctime>
#include <utility>

#include <fmt/format.h>

#include "daemon/status/add_member.h"

namespace merlin::status {
namespace {

// Writes a local time as text: "2026-11-24T18:00".
std::string localText(std::int64_t local_minute) {
  const auto seconds = static_cast<std::time_t>(60 * local_minute);
  std::tm tm{};
  ::gmtime_r(&seconds, &tm);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}", tm.tm_year + 1900, tm.tm_mon + 1, tm.tm_mday,
                     tm.tm_hour, tm.tm_min);
}

}  // namespace

std::string addProjectors(const std::string& document,
                          const std::vector<ProjectorStatus>& projectors,
                          const std::optional<ProjectorSwitching>& next) {
  nlohmann::ordered_json all;
  for (const ProjectorStatus& p : projectors) {
    all[p.name] = {{"kind", p.kind},         {"power", p.power},          {"wanted", p.wanted},
                   {"health", p.health},     {"reason", p.reason},        {"address", p.address},
                   {"identity", p.identity}, {"lamp_hours", p.lamp_hours}};
    if (p.within_s) all[p.name]["within_s"] = *p.within_s;
  }
  nlohmann::ordered_json schedule;
  if (next) schedule = {{"at", localText(next->local_minute)}, {"on", next->on}};
  return addMember(addMember(document, "projectors", std::move(all)), "projector_schedule",
                   std::move(schedule));
}

std::vector<ProjectorStatus> projectorsIn(const std::string& document) {
  const auto parsed = nlohmann::json::parse(document, nullptr, false);
  const auto list = parsed.is_object() ? parsed.find("projectors") : parsed.end();
  std::vector<ProjectorStatus> all;
  if (list == parsed.end() || !list->is_object()) return all;
  for (const auto& [name, projector] : list->items()) {
    const auto text = [&, &projector = projector](const char* key) {
      const auto found = projector.find(key);
      return found != projector.end() && found->is_string() ? found->template get<std::string>()
                                                            : std::string();
    };
    ProjectorStatus status;
    status.name = name;
    status.power = text("power");
    status.wanted = text("wanted");
    all.push_back(std::move(status));
  }
  return all;
}

}  // namespace merlin::status
