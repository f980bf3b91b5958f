// What the configuration says of the servers for other programs.
#pragma once

#include <string>

namespace merlin {

struct ServeSettings {
  // The space-mouse socket that libspnav looks for; empty: none. /run/spnav.sock is the usual one.
  std::string spnav_socket;
  // VRPN's port, TCP and UDP, on the loopback device; 0: none. 3883 is the usual one.
  int vrpn_port = 0;
  // Where samples go to other machines, encrypted: "tcp://*:7401"; empty: nowhere.
  std::string samples_endpoint;
  std::string samples_keys;     // this machine's pair of keys, a file
  std::string samples_clients;  // public keys of those who may listen, a file, one a line
};

}  // namespace merlin
