// The VRPN servers that `merlin devices` asks, and their answers. VRPN has no way to ask a network
// for its servers, so each is asked that somebody may have named.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "drivers/vrpn/catalog.h"

namespace merlin::cli {

// "lab", "lab:4000" and "tcp://lab:4000" as a port of the configuration: "tcp://lab:3883"; nothing
// if the text is none of these.
std::optional<std::string> vrpnPort(const std::string& text);

// What a running merlind reads under this name, by its health; nothing if that is no device of a
// VRPN server, or one that has not been opened yet.
std::optional<DeviceSettings> vrpnDeviceOf(const std::string& name, const std::string& port,
                                           const std::string& identity);

// That at VRPN's usual port of this machine, those of the configuration's devices, and `given`, in
// this order, each once. REQUIRES: `given` are ports.
std::vector<std::string> serversToAsk(const DevicesSettings& devices,
                                      const std::vector<std::string>& given);

struct VrpnAnswer {
  std::string port;  // "tcp://HOST:PORT"
  vrpn::Catalog catalog;
  std::string fault;  // why nothing came, or nothing more; empty: none
};

// Asks all at once, and waits for all of them `wait`, and at most 0.1 s longer. Who has not
// answered by then has the fault. A thread that still looks up a name, which cannot be interrupted,
// is left to itself; it touches nothing of the caller's. REQUIRES: `ports` are of kind kTcp.
std::vector<VrpnAnswer> askServers(const std::vector<std::string>& ports, Duration wait);

}  // namespace merlin::cli
