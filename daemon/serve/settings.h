// Settings of the servers for other programs.
#pragma once

#include <string>

#include "daemon/base/setting_fault.h"

namespace merlin {

struct ServeSettings {
  // The space-mouse socket that libspnav opens, usually /run/spnav.sock; empty: no such server.
  std::string spnav_socket;
  // VRPN's port, TCP and UDP, on the loopback device, usually 3883; 0: no such server.
  int vrpn_port = 0;
  // Address at which other machines get samples, encrypted, "tcp://*:7401"; empty: no such server.
  std::string samples_endpoint;
  std::string samples_keys;     // file with this machine's key pair
  std::string samples_clients;  // file with the public keys of allowed clients, one per line
};

// Finds an address that cannot be used, or that has no keys: traffic over a network must be
// encrypted. Pointer: "/samples_endpoint".
SettingFaults validate(const ServeSettings& serve);

}  // namespace merlin
