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
  // Addresses at which each role answers requests of other machines, encrypted, "tcp://*:7402";
  // empty: none.
  std::string wall_endpoint, devices_endpoint;
  // Address at which other machines follow the wall's topics, encrypted; empty: none. Those of the
  // devices are at samples_endpoint.
  std::string wall_topics_endpoint;
  std::string commands_keys;     // file with this machine's key pair, for these three
  std::string commands_clients;  // file with the public keys that may send commands, one per line
  std::string commands_readers;  // file with the public keys that may only read status and events

  bool hasNetworkCommands() const noexcept {
    return !wall_endpoint.empty() || !devices_endpoint.empty();
  }
};

// Finds an address that cannot be used, that is used twice, or that has no keys: traffic over a
// network must be encrypted. Pointers: "/samples_endpoint", "/wall_endpoint", "/devices_endpoint",
// "/wall_topics_endpoint".
SettingFaults validate(const ServeSettings& serve);

}  // namespace merlin
