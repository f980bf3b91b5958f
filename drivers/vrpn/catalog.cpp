#include "drivers/vrpn/catalog.h"

#include <algorithm>

#include "daemon/base/printable_text.h"
#include "drivers/vrpn/server_checks.h"

namespace merlin::vrpn {
namespace {

constexpr std::size_t kMostTypes = 64;  // greatest number of types whose numbers are kept
// Name of an internal sender of VRPN's own vrpn_server.
constexpr std::string_view kForwarder = "vrpn_Forwarder_Brain";

struct KnownType {
  std::string_view name;
  bool Measures::*of;
};
constexpr KnownType kKnownTypes[] = {{kVrpnPoseType, &Measures::poses},
                                     {kVrpnButtonType, &Measures::buttons},
                                     {kVrpnButtonsType, &Measures::buttons},
                                     {kVrpnChannelsType, &Measures::channels}};

bool canBeConfigured(std::string_view name) {
  SettingFaults faults;
  checkName(std::string(name), "", faults);
  return faults.empty() && isText(name);
}

}  // namespace

Result<Ok> Catalog::take(std::string_view bytes) {
  if (!greeted()) {
    const std::size_t missing = kVrpnCookieLength - greeting_.size();
    greeting_ += bytes.substr(0, missing);
    bytes.remove_prefix(std::min(missing, bytes.size()));
    if (!greeted()) return Ok{};
    if (auto fits = checkGreeting(greeting_); !fits) return fits;
  }
  for (const char byte : bytes) {
    const auto message = takeByte(parser_, static_cast<std::byte>(byte));
    if (!message) return message.error();
    if (*message) handle(**message);
  }
  return Ok{};
}

std::string_view Catalog::version() const {
  return greeted() ? vrpnVersion(greeting_) : std::string_view();
}

void Catalog::handle(const Message& message) {
  const VrpnHeader& header = message.header;
  if (header.type == kVrpnDescribeSender || header.type == kVrpnDescribeType) {
    const auto name = readVrpnName(message.payload).value_or(std::string_view());
    return header.type == kVrpnDescribeSender ? describeSender(header.sender, name)
                                              : describeType(header.sender, name);
  }
  const auto sender = senders_.find(header.sender);
  const auto type = types_.find(header.type);
  if (sender != senders_.end() && type != types_.end())
    devices_[sender->second].sent.*type->second = true;
}

// If the server gives a known number a new name, the number then denotes another device.
void Catalog::describeSender(std::int32_t number, std::string_view name) {
  senders_.erase(number);
  if (name == kVrpnControl || name == kForwarder) return;
  const bool room = senders_.size() < kMostDevices;
  const CatalogDevice* const device = room && canBeConfigured(name) ? named(name) : nullptr;
  if (!device) {
    ++left_out_;
    return;
  }
  senders_[number] = static_cast<std::size_t>(device - devices_.data());
}

// Returns the device of this name, and adds it if it is new; null if there is no room.
CatalogDevice* Catalog::named(std::string_view name) {
  const auto known = std::ranges::find(devices_, name, &CatalogDevice::name);
  if (known != devices_.end()) return &*known;
  if (devices_.size() >= kMostDevices) return nullptr;
  return &devices_.emplace_back(CatalogDevice{std::string(name), {}});
}

void Catalog::describeType(std::int32_t number, std::string_view name) {
  types_.erase(number);
  const std::string_view prefix = kVrpnInstance;
  if (name.starts_with(prefix)) instance_ = name.substr(prefix.size());
  const auto* const known = std::ranges::find(kKnownTypes, name, &KnownType::name);
  if (known == std::end(kKnownTypes)) return;
  described_.*known->of = true;
  if (types_.size() < kMostTypes) types_[number] = known->of;
}

}  // namespace merlin::vrpn
