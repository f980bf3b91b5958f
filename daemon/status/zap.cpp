#include "daemon/status/zap.h"

#include <algorithm>
#include <cstdint>

#include <zmq.h>

namespace merlin::status {
namespace {

constexpr std::size_t kFrames = 7, kId = 1, kDomain = 2, kMechanism = 5, kKey = 6;
constexpr std::size_t kKeyBytes = 32, kKeyText = 40;

// Encodes a binary key as Z85; returns an empty text if the key does not have 32 bytes.
std::string z85(const std::string& key) {
  char text[kKeyText + 1] = "";
  if (key.size() != kKeyBytes) return {};
  ::zmq_z85_encode(text, reinterpret_cast<const std::uint8_t*>(key.data()), key.size());
  return text;
}

bool contains(const std::vector<std::string>& keys, const std::string& key) {
  return std::ranges::find(keys, key) != keys.end();
}

Grant grantOfRequest(std::span<const std::string> request, const Doors& doors) {
  if (request.size() != kFrames || request[0] != "1.0" || request[kMechanism] != "CURVE")
    return Grant::kNothing;
  const auto door = doors.find(request[kDomain]);
  return door == doors.end() ? Grant::kNothing : door->second.grantOf(z85(request[kKey]));
}

}  // namespace

Grant Door::grantOf(const std::string& key) const {
  if (key.empty()) return Grant::kNothing;
  if (contains(commanders, key)) return Grant::kCommand;
  return contains(readers, key) ? Grant::kRead : Grant::kNothing;
}

std::vector<std::string> zapAnswer(std::span<const std::string> request, const Doors& doors) {
  const Grant grant = grantOfRequest(request, doors);
  const bool known = grant != Grant::kNothing;
  return {"1.0",
          request.size() > kId ? request[kId] : "",
          known ? "200" : "400",
          known ? "OK" : "unknown key",
          userOf(grant),
          ""};
}

std::string userOf(Grant grant) {
  if (grant == Grant::kNothing) return "";
  return grant == Grant::kCommand ? "command" : "read";
}

Grant grantOfUser(std::string_view user) {
  for (const Grant grant : {Grant::kRead, Grant::kCommand}) {
    if (user == userOf(grant)) return grant;
  }
  return Grant::kNothing;
}

}  // namespace merlin::status
