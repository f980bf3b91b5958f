#include "daemon/serve/settings.h"

#include <fmt/format.h>

#include "daemon/base/tcp_address.h"

namespace merlin {

SettingFaults validate(const ServeSettings& s) {
  SettingFaults faults;
  if (s.samples_endpoint.empty()) return faults;
  if (!parseTcpAddress(s.samples_endpoint)) {
    faults.push_back({"/samples_endpoint",
                      fmt::format("is \"{}\"; allowed is tcp://ADDRESS:PORT, ADDRESS * for any, "
                                  "PORT 1 to 65535",
                                  s.samples_endpoint)});
  }
  if (s.samples_keys.empty() || s.samples_clients.empty()) {
    faults.push_back(
        {"/samples_endpoint",
         "also needs samples_keys (merlin keys -o FILE creates it) and samples_clients"});
  }
  return faults;
}

}  // namespace merlin
