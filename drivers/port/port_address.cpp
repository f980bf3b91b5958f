#include "drivers/port/port_address.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <optional>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>

#include "daemon/base/tcp_address.h"

namespace merlin {
namespace {

constexpr int kSpeeds[] = {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};
constexpr const char* kForms =
    "serial:/dev/..., pty:PATH, tcp://HOST:PORT, udp:PORT, udp://ADDRESS:PORT, unix:PATH, "
    "evdev:/dev/input/... and replay:FILE";

// Kinds of ports whose bytes have a format of their own, which only some drivers can read.
struct OwnForm {
  PortKind kind = PortKind::kEvdev;
  const char* what = "";
  std::array<std::string_view, 2> drivers;
};
constexpr OwnForm kOwnForms[] = {
    {PortKind::kEvdev, "an input device of the kernel", {"evdev", "touch"}},
    {PortKind::kUdp, "a port for datagrams", {"tuio", "osc"}},
};

// Parses "udp:PORT" or "udp://ADDRESS:PORT", where ADDRESS is numeric.
std::optional<PortAddress> parseUdp(std::string_view text) {
  constexpr std::string_view kScheme = "udp:", kLoopback = "127.0.0.1";
  if (!text.starts_with(kScheme)) return std::nullopt;
  text.remove_prefix(kScheme.size());
  const bool whole = text.starts_with("//");
  const auto address = parseTcpAddress(whole ? fmt::format("tcp:{}", text)
                                             : fmt::format("tcp://{}:{}", kLoopback, text));
  if (!address) return std::nullopt;
  std::array<unsigned char, 16> bytes{};
  if (::inet_pton(AF_INET, address->host.c_str(), bytes.data()) != 1 &&
      ::inet_pton(AF_INET6, address->host.c_str(), bytes.data()) != 1)
    return std::nullopt;
  return PortAddress{PortKind::kUdp, address->host, address->port};
}

// A network address as 16 bytes; an IPv4 address has the form ::ffff:a.b.c.d.
using NetworkAddress = std::array<unsigned char, 16>;
constexpr NetworkAddress kAnyIpv4{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF}, kAny{};

std::optional<NetworkAddress> networkAddress(const std::string& host) {
  NetworkAddress bytes = kAnyIpv4;
  if (::inet_pton(AF_INET, host.c_str(), &bytes[12]) == 1) return bytes;
  if (::inet_pton(AF_INET6, host.c_str(), bytes.data()) == 1) return bytes;
  return std::nullopt;
}

bool isIpv4(const NetworkAddress& address) {
  return std::equal(kAnyIpv4.begin(), kAnyIpv4.begin() + 12, address.begin());
}

// Returns whether a datagram to one of these local addresses may also arrive at the other address;
// :: includes all addresses of IPv4.
bool overlap(const NetworkAddress& a, const NetworkAddress& b) {
  const auto within = [](const NetworkAddress& all, const NetworkAddress& one) {
    return all == kAny || (all == kAnyIpv4 && isIpv4(one));
  };
  return a == b || within(a, b) || within(b, a);
}

bool sameName(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

bool sameHost(const PortAddress& a, const PortAddress& b) {
  const auto numeric = [](const std::string& host) {
    return networkAddress(sameName(host, "localhost") ? "127.0.0.1" : host);
  };
  const auto first = numeric(a.path), second = numeric(b.path);
  if (!first || !second) return !first && !second && sameName(a.path, b.path);
  return a.kind == PortKind::kUdp ? overlap(*first, *second) : *first == *second;
}

// Returns the number of a port without leading zeros.
std::string_view plainNumber(std::string_view port) {
  return port.substr(std::min(port.size(), port.find_first_not_of('0')));
}

}  // namespace

std::span<const int> lineSpeeds() { return kSpeeds; }

Result<PortAddress> parsePort(std::string_view text) {
  constexpr std::pair<std::string_view, PortKind> kPrefixes[] = {{"serial:", PortKind::kSerial},
                                                                 {"pty:", PortKind::kPty},
                                                                 {"unix:", PortKind::kUnix},
                                                                 {"evdev:", PortKind::kEvdev},
                                                                 {"replay:", PortKind::kReplay}};
  for (const auto& [prefix, kind] : kPrefixes) {
    if (text.starts_with(prefix) && text.size() > prefix.size())
      return PortAddress{kind, std::string(text.substr(prefix.size())), {}};
  }
  if (auto tcp = parseTcpAddress(text); tcp && tcp->host != "*")
    return PortAddress{PortKind::kTcp, std::move(tcp->host), std::move(tcp->port)};
  if (auto udp = parseUdp(text)) return *std::move(udp);
  return Error{Errc::kInvalidArgument,
               fmt::format("\"{}\" is not a valid port; ports are {}", text, kForms)};
}

bool sameLine(const PortAddress& a, const PortAddress& b) {
  if (a.kind == PortKind::kReplay) return false;
  if (a.kind != b.kind && !(a.hasSpeed() && b.hasSpeed())) return false;
  if (a.service.empty()) return a.path == b.path;
  return plainNumber(a.service) == plainNumber(b.service) && sameHost(a, b);
}

SettingFaults validate(const LineSettings& line) {
  SettingFaults faults;
  const auto port = parsePort(line.port);
  for (const OwnForm& form : kOwnForms) {
    if (!port || port->kind != form.kind || std::ranges::count(form.drivers, line.driver) > 0)
      continue;
    faults.push_back({"/port", fmt::format("is \"{}\", {}, which the driver \"{}\" does not read; "
                                           "the drivers \"{}\" do",
                                           line.port, form.what, line.driver,
                                           fmt::join(form.drivers, "\" and \""))});
  }
  if (!line.port.empty() && !port) {
    faults.push_back({"/port", fmt::format("is \"{}\"; allowed are {}, or \"\" for no device",
                                           line.port, kForms)});
  }
  const bool known =
      std::find(std::begin(kSpeeds), std::end(kSpeeds), line.baud) != std::end(kSpeeds);
  if (line.baud != 0 && !known) {
    faults.push_back({"/baud", fmt::format("is {}; allowed are {}, and 0 for the driver's usual "
                                           "speed",
                                           line.baud, fmt::join(kSpeeds, ", "))});
  }
  return faults;
}

}  // namespace merlin
