#include "drivers/vrpn/pad_device.h"

#include "drivers/vrpn/identity.h"

namespace merlin::vrpn {
namespace {

enum Type : std::size_t { kButton, kButtons, kChannels };
constexpr const char* kTypes[] = {kVrpnButtonType, kVrpnButtonsType, kVrpnChannelsType};

constexpr const char* kNotDescribed = "the server has not described the device";
constexpr const char* kLeft = "the server no longer has the device";
constexpr const char* kNoPad = "the server serves neither buttons nor analogs";

}  // namespace

VrpnPad::VrpnPad(const VrpnPadSettings& settings, const Clock& clock, SampleSink& sink)
    : name_(settings.device),
      clock_(clock),
      client_(settings.device, kTypes, clock, *this),
      ball_(sink),
      input_(settings) {}

Result<std::string> VrpnPad::open(ByteStream& stream) {
  ball_.restart();
  input_.rest();
  complaint_ = "";
  const auto version =
      client_.open(stream, [&] { return client_.knowsDevice() ? "" : kNotDescribed; });
  if (!version) return version.error();
  ball_.settle(clock_.now());
  return padIdentity(name_, *version);
}

Result<Ok> VrpnPad::poll(ByteStream& stream) {
  const auto polled = client_.poll(stream, ball_.wait(clock_.now()));
  if (!polled) return polled;
  const bool known = client_.knowsDevice();
  complaint_ = !known ? kLeft : client_.knowsAType() ? "" : kNoPad;
  if (!known) {  // pushes and pressed buttons have ended
    input_.rest();
    ball_.restart();
    ball_.settle(clock_.now());
  }
  ball_.hold(clock_.now());
  return polled;
}

bool VrpnPad::take(std::size_t type, std::string_view payload, Timestamp first_byte) noexcept {
  if (!takePayload(type, payload)) return false;
  input_.fill(ball_.sample());
  ball_.publish(first_byte);
  return true;
}

bool VrpnPad::takePayload(std::size_t type, std::string_view payload) noexcept {
  const auto taken = [&](const auto& read) {
    if (read) input_.take(*read);
    return read.has_value();
  };
  switch (type) {
    case kButton: return taken(readVrpnButton(payload));
    case kButtons: return taken(readVrpnButtons(payload));
    default: return taken(readVrpnChannels(payload));
  }
}

std::unique_ptr<Device> makeDevice(const VrpnPadSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<VrpnPad>(settings, clock, sink);
}

}  // namespace merlin::vrpn
