#include "daemon/status/projectors.h"

#include <nlohmann/json.hpp>

namespace merlin::status {

std::string addProjectors(const std::string& document,
                          const std::vector<ProjectorStatus>& projectors) {
  using Json = nlohmann::ordered_json;
  Json json = Json::parse(document, nullptr, false);
  if (projectors.empty() || !json.is_object()) return document;
  Json& all = json["projectors"];
  for (const ProjectorStatus& p : projectors) {
    all[p.name] = {{"kind", p.kind},         {"power", p.power},          {"wanted", p.wanted},
                   {"health", p.health},     {"reason", p.reason},        {"address", p.address},
                   {"identity", p.identity}, {"lamp_hours", p.lamp_hours}};
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace merlin::status
