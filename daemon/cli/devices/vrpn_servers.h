// The VRPN servers that `merlin devices` asks, and their answers. VRPN has no way to discover the
// servers in a network, so only known or given servers are asked.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "drivers/vrpn/catalog.h"

namespace merlin::cli {

// Converts "lab", "lab:4000" or "tcp://lab:4000" to a port of the configuration, such as
// "tcp://lab:3883"; nothing if the text is none of these.
std::optional<std::string> vrpnPort(const std::string& text);

// The device that a running merlind reads under this name, according to its health; nothing if it
// is no device of a VRPN server, or has not been opened yet.
std::optional<DeviceSettings> vrpnDeviceOf(const std::string& name, const std::string& port,
                                           const std::string& identity);

// The servers to ask: the one at VRPN's usual port of this machine, those of the configuration's
// devices, and `given`, in this order, each once. REQUIRES: `given` are ports.
std::vector<std::string> serversToAsk(const DevicesSettings& devices,
                                      const std::vector<std::string>& given);

struct VrpnAnswer {
  std::string port;  // "tcp://HOST:PORT"
  vrpn::Catalog catalog;
  std::string fault;  // why nothing arrived, or nothing more; empty: no fault
};

// Asks all servers at once, and waits for `wait`, at most 0.1 s longer. A server that has not
// answered by then gets a fault. A thread that is still looking up a name, which cannot be
// interrupted, is left running; it uses none of the caller's memory. REQUIRES: `ports` are of kind
// kTcp.
std::vector<VrpnAnswer> askServers(const std::vector<std::string>& ports, Duration wait);

}  // namespace merlin::cli
