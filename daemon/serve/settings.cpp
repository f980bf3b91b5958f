#include "daemon/serve/settings.h"

#include <fmt/format.h>

#include "daemon/base/tcp_address.h"

namespace merlin {
namespace {

struct Endpoint {
  const char* pointer;
  const std::string& address;
  bool has_keys;
  const char* keys;  // the settings that name the keys
};

void validate(const Endpoint& endpoint, SettingFaults& faults) {
  if (endpoint.address.empty()) return;
  if (!parseTcpAddress(endpoint.address)) {
    faults.push_back({endpoint.pointer,
                      fmt::format("is \"{}\"; allowed is tcp://ADDRESS:PORT, ADDRESS * for any, "
                                  "PORT 1 to 65535",
                                  endpoint.address)});
  }
  if (!endpoint.has_keys)
    faults.push_back({endpoint.pointer, fmt::format("also needs {}", endpoint.keys)});
}

}  // namespace

SettingFaults validate(const ServeSettings& s) {
  constexpr const char* kSamples =
      "samples_keys (merlin keys -o FILE creates it) and samples_clients";
  constexpr const char* kCommands =
      "commands_keys (merlin keys -o FILE creates it), and commands_clients or commands_readers";
  const bool samples = !s.samples_keys.empty() && !s.samples_clients.empty();
  const bool commands =
      !s.commands_keys.empty() && !(s.commands_clients.empty() && s.commands_readers.empty());
  const Endpoint all[] = {{"/samples_endpoint", s.samples_endpoint, samples, kSamples},
                          {"/wall_endpoint", s.wall_endpoint, commands, kCommands},
                          {"/devices_endpoint", s.devices_endpoint, commands, kCommands},
                          {"/wall_topics_endpoint", s.wall_topics_endpoint, commands, kCommands}};
  SettingFaults faults;
  for (const Endpoint& endpoint : all) validate(endpoint, faults);
  for (const Endpoint& a : all) {
    for (const Endpoint* b = all; b != &a; ++b) {
      if (!a.address.empty() && a.address == b->address)
        faults.push_back({a.pointer, fmt::format("is the same address as that of /serve{}; each "
                                                 "needs a port of its own",
                                                 b->pointer)});
    }
  }
  return faults;
}

}  // namespace merlin
