#include "daemon/status/projectors.h"

#include <utility>

#include "daemon/status/add_member.h"

namespace merlin::status {

std::string addProjectors(const std::string& document,
                          const std::vector<ProjectorStatus>& projectors) {
  nlohmann::ordered_json all;
  for (const ProjectorStatus& p : projectors) {
    all[p.name] = {{"kind", p.kind},         {"power", p.power},          {"wanted", p.wanted},
                   {"health", p.health},     {"reason", p.reason},        {"address", p.address},
                   {"identity", p.identity}, {"lamp_hours", p.lamp_hours}};
  }
  return addMember(document, "projectors", std::move(all));
}

}  // namespace merlin::status
