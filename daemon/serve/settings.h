// Settings of the servers for other programs.
#pragma once

#include <string>

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

}  // namespace merlin
