#include "daemon/page/settings.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>

#include "daemon/base/printable_text.h"
#include "daemon/page/host_names.h"

namespace merlin {

SettingFaults validate(const PageSettings& s) {
  SettingFaults faults;
  in_addr address{};
  if (::inet_pton(AF_INET, s.address.c_str(), &address) != 1) {
    faults.push_back({"/address", fmt::format("is \"{}\"; allowed is an IPv4 address: 127.0.0.1 "
                                              "for this machine alone, 0.0.0.0 for all networks",
                                              excerpt(s.address))});
  }
  for (const std::string& name : page::wordsOf(s.host_names)) {
    if (page::isHostName(name)) continue;
    faults.push_back({"/host_names", fmt::format("has \"{}\"; allowed are names of hosts without a "
                                                 "port, of letters, digits, - and dots, separated "
                                                 "by spaces",
                                                 excerpt(name))});
  }
  return faults;
}

bool isLoopback(const std::string& address) {
  in_addr parsed{};
  return ::inet_pton(AF_INET, address.c_str(), &parsed) == 1 && ntohl(parsed.s_addr) >> 24 == 127;
}

}  // namespace merlin
