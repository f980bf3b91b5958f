// Settings of the operator's web page.
#pragma once

#include <string>

#include "daemon/base/setting_fault.h"

namespace merlin {

struct PageSettings {
  bool enabled = true;                // the page itself, with its pictures and commands
  bool metrics = true;                // /metrics, which works without the page
  std::string address = "127.0.0.1";  // IPv4 address at which both listen
  int port = 7480;
  // Names under which browsers reach the page besides IP addresses and localhost, separated by
  // spaces.
  std::string host_names;
  double picture_hz = 5;  // pictures per second that a browser gets at most
};

// Pointers: "/address", "/host_names".
SettingFaults validate(const PageSettings& page);

// Whether an address can be reached from this machine only. REQUIRES: it is a valid IPv4 address.
bool isLoopback(const std::string& address);

}  // namespace merlin
