// Asks VRPN servers for their devices, for `merlin devices`. VRPN cannot discover the servers in a
// network, so only known or given servers are asked.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "drivers/vrpn/catalog.h"

namespace merlin::cli {

// Converts "lab", "lab:4000" or "tcp://lab:4000" to a port of the configuration, such as
// "tcp://lab:3883"; nothing if the text has none of these forms.
std::optional<std::string> vrpnPort(const std::string& text);

// Returns the settings of a device that a running merlind reads from a VRPN server; nothing if
// `identity` is not that of such a device. `name`, `port`, `identity`: from the device and its
// health in shared memory; the identity is empty until the device was opened.
std::optional<DeviceSettings> vrpnDeviceOf(const std::string& name, const std::string& port,
                                           const std::string& identity);

// Returns the ports of the servers to ask, each once: the usual VRPN port of this machine, the
// servers of `devices`, and `given`, in this order. REQUIRES: `given` are valid TCP ports.
std::vector<std::string> serversToAsk(const DevicesSettings& devices,
                                      const std::vector<std::string>& given);

// The answer of one server.
struct VrpnAnswer {
  std::string port;  // "tcp://HOST:PORT"
  vrpn::Catalog catalog;
  std::string fault;  // why the catalog is empty or incomplete; empty: no fault
};

// Asks all servers at once, each on a thread of its own, and returns the answers after at most
// `wait` plus 0.1 s. A server that has not answered by then has a fault. A thread that is still
// looking up a host name cannot be interrupted and is left running; it uses none of the caller's
// memory. REQUIRES: `ports` are of kind kTcp.
std::vector<VrpnAnswer> askServers(const std::vector<std::string>& ports, Duration wait);

}  // namespace merlin::cli
