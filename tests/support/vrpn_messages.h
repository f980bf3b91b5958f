// Makes messages of a VRPN server, as bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/port/vrpn_line.h"

namespace merlin::test {

inline std::string vrpnMessage(std::int32_t sender, std::int32_t type, std::string_view payload) {
  VrpnHeader header;
  header.sender = sender;
  header.type = type;
  std::string bytes;
  appendVrpn(header, payload, bytes);
  return bytes;
}
// Return a message that describes a sender or a message type, respectively.
inline std::string vrpnSender(std::int32_t number, std::string_view name) {
  return vrpnMessage(number, kVrpnDescribeSender, vrpnName(name));
}
inline std::string vrpnType(std::int32_t number, std::string_view name) {
  return vrpnMessage(number, kVrpnDescribeType, vrpnName(name));
}

}  // namespace merlin::test
