#include "drivers/vrpn/identity.h"

#include <fmt/format.h>

namespace merlin::vrpn {
namespace {

constexpr std::string_view kTracker = "VRPN tracker ", kPad = "VRPN buttons and analogs ",
                           kVersion = " at server version ";

}  // namespace

std::string trackerIdentity(std::string_view device, std::string_view version) {
  return fmt::format("{}{}{}{}", kTracker, device, kVersion, version);
}

std::string padIdentity(std::string_view device, std::string_view version) {
  return fmt::format("{}{}{}{}", kPad, device, kVersion, version);
}

std::optional<Identified> readIdentity(std::string_view identity) {
  const bool tracker = identity.starts_with(kTracker);
  if (!tracker && !identity.starts_with(kPad)) return std::nullopt;
  identity.remove_prefix(tracker ? kTracker.size() : kPad.size());
  const std::string_view device = identity.substr(0, identity.rfind(kVersion));
  return Identified{tracker ? "vrpn" : "vrpn_pad", std::string(device)};
}

}  // namespace merlin::vrpn
