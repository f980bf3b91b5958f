// The address at which a phone reaches the page.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::page {

struct PagePlace {
  std::string address;                // at which the page listens, IPv4
  int port = 0;                       // likewise
  std::vector<std::string> networks;  // this machine's own addresses in networks
};

// "http://10.0.0.5:7480/". If the browser that asks is not on this machine, a phone goes the same
// way: `origin`, which the gate has accepted, may be a proxy's. Otherwise it is the address at
// which the page listens, or this machine's first. Pure. Errors: kNotFound, with what to do (the
// page listens on this machine alone, or the machine is in no network).
Result<std::string> phoneAddress(const std::string& origin, const PagePlace& place);

// IPv4 addresses of this machine's interfaces that are up, without loopback.
std::vector<std::string> networkAddresses();

}  // namespace merlin::page
