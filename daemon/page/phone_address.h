// The address at which a phone reaches the page.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::page {

struct PagePlace {
  std::string address;                // IPv4 address at which the page listens
  int port = 0;                       // port at which the page listens
  std::vector<std::string> networks;  // this machine's own addresses in networks
};

// Returns the address of the page for a phone, such as "http://10.0.0.5:7480/". If the requesting
// browser is not on this machine, a phone uses the same address as the browser: `origin`, which the
// gate has accepted and which may be a proxy's. Otherwise it uses the address at which the page
// listens, or this machine's first network address. Pure. Errors: kNotFound, with what to do (the
// page listens on this machine alone, or the machine is in no network).
Result<std::string> phoneAddress(const std::string& origin, const PagePlace& place);

// Returns the IPv4 addresses of this machine's interfaces that are up, without loopback.
std::vector<std::string> networkAddresses();

}  // namespace merlin::page
