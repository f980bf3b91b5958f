// The identities of devices of VRPN servers, in the form in which their drivers report them. Pure.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace merlin::vrpn {

// Return identities such as "VRPN tracker Wand0 at server version 07.38" and "VRPN buttons and
// analogs Wand0 at server version 07.38".
std::string trackerIdentity(std::string_view device, std::string_view version);
std::string padIdentity(std::string_view device, std::string_view version);

struct Identified {
  std::string driver;  // "vrpn" or "vrpn_pad"
  std::string device;  // its name at the server; truncated if the identity was
};
// Parses an identity; returns nothing if it is not the identity of a device of a VRPN server.
std::optional<Identified> readIdentity(std::string_view identity);

}  // namespace merlin::vrpn
