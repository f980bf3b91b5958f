#include "daemon/status/add_member.h"

#include <utility>

namespace merlin::status {

std::string addMember(const std::string& document, const char* name, nlohmann::ordered_json value) {
  if (value.empty()) return document;
  auto json = nlohmann::ordered_json::parse(document, nullptr, false);
  if (!json.is_object()) return document;
  json[name] = std::move(value);
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace merlin::status
