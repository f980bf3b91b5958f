// VRPN's wire format, as far as a server of trackers, buttons and analogs needs it. No I/O, no
// clock.
//
// Both sides begin with a cookie of 24 bytes. A message: i32be x 5: length (24 + payload), seconds,
// microseconds, sender, type; i32be sequence number; payload, padded to a multiple of 8. Negative
// types are the system's: -1 describes a sender, -2 a type, each by a name.
//
// Source: vrpn_Connection.C, vrpn_Tracker.C, vrpn_Analog.C, vrpn_Button.C; README.md beside this.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace merlin::serve {

inline constexpr std::size_t kVrpnCookieLength = 24;
// The cookie that we send.
std::string vrpnCookie();

// Whether the peer's cookie agrees with ours up to the last '.' of the version. REQUIRES: `cookie`
// has 24 bytes.
bool vrpnCookieFits(std::string_view cookie);

struct VrpnMessage {
  std::int32_t seconds = 0, microseconds = 0;
  std::int32_t sender = 0, type = 0;
  std::uint32_t sequence = 0;
  std::string payload;
};
std::string encodeVrpn(const VrpnMessage& message);

// The longest message that is accepted, including header and padding.
inline constexpr std::size_t kVrpnLongest = 8192;

// The message at the front of the input; nothing if it is not complete yet.
struct VrpnFront {
  std::optional<VrpnMessage> message;
  std::size_t bytes = 0;  // length of the message in the input
  bool broken = false;    // invalid length: the connection must be closed
};
VrpnFront readVrpn(std::string_view input);

// Encode and decode payloads.
std::string vrpnName(std::string_view name);  // of a message that describes a sender or type
std::optional<std::string> readVrpnName(std::string_view payload);
std::string vrpnPose(std::int32_t sensor, std::span<const float> position_m,
                     std::span<const float> orientation_wxyz);  // Pos_Quat: x y z, qx qy qz qw
std::string vrpnChannels(std::span<const double> channels);     // Analog Channel
std::string vrpnButton(std::int32_t button, bool down);         // Button Change
std::string vrpnButtons(std::uint32_t down,
                        std::int32_t count);  // Button States: bit i is button i

// Parses a UDP datagram, "127.0.0.1 59207" + NUL, by which a client asks us to connect to it.
// Nothing if it is malformed, the port is below 1024, or the host has characters other than
// letters, digits and dots.
struct VrpnCallback {
  std::string host;
  int port;
};
std::optional<VrpnCallback> readVrpnCallback(std::string_view datagram);

}  // namespace merlin::serve
