// The VRPN wire format, cookies and messages, as our server (daemon/serve) and our client
// (drivers/vrpn) use it. Pure.
//
// Both sides begin with a cookie of 24 bytes. A message: i32be x 5: length (24 + payload), seconds,
// microseconds, sender, type; i32be sequence number; payload, padded to a multiple of 8. Negative
// types are the system's: -1 describes a sender, -2 a type, each by a name; the field of the sender
// holds the number that is described. Each side assigns its own numbers.
//
// Source: VRPN 07.38, vrpn_Connection.C, vrpn_Tracker.C, vrpn_Button.C, vrpn_Analog.C.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace merlin {

inline constexpr std::size_t kVrpnCookieLength = 24;
inline constexpr std::size_t kVrpnHeaderLength = 24;

// Message types of VRPN itself: their numbers are fixed, so no message has to announce them.
inline constexpr std::int32_t kVrpnDescribeSender = -1, kVrpnDescribeType = -2,
                              kVrpnDisconnect = -5;

// Names of senders and types that both sides use.
inline constexpr const char* kVrpnControl = "VRPN Control";
inline constexpr const char* kVrpnPing = "vrpn_Base ping_message";
inline constexpr const char* kVrpnPong = "vrpn_Base pong_message";
inline constexpr const char* kVrpnPoseType = "vrpn_Tracker Pos_Quat";
inline constexpr const char* kVrpnButtonType = "vrpn_Button Change";   // state of one button
inline constexpr const char* kVrpnButtonsType = "vrpn_Button States";  // states of all buttons
inline constexpr const char* kVrpnChannelsType = "vrpn_Analog Channel";

// A server of MERLIN also describes a type of this name with its instance after it. No message has
// this type. It identifies the server, so that a merlind does not offer its own devices to itself.
inline constexpr const char* kVrpnInstance = "MERLIN instance ";

// Maximum numbers of buttons and channels of one device in VRPN; both are numbered from 0.
inline constexpr std::size_t kVrpnButtons = 256, kVrpnChannels = 128;

// Returns the cookie that MERLIN sends.
std::string vrpnCookie();

// Returns whether the peer's cookie agrees with MERLIN's up to the last '.' of the version.
// REQUIRES: `cookie` has 24 bytes.
bool vrpnCookieFits(std::string_view cookie);

// Returns the version in a cookie that vrpnCookieFits() accepts, such as "07.38".
std::string_view vrpnVersion(std::string_view cookie);

struct VrpnHeader {
  std::int32_t seconds = 0, microseconds = 0;  // time of day
  std::int32_t sender = 0, type = 0;
  std::uint32_t sequence = 0;
};

// Appends the message's bytes.
void appendVrpn(const VrpnHeader& header, std::string_view payload, std::string& out);

// The beginning of a message.
struct VrpnStart {
  VrpnHeader header;
  std::size_t payload = 0;  // length of the payload without padding
  std::size_t bytes = 0;    // length of the whole message; 0: invalid, no message has this length
};
// REQUIRES: `bytes` begins with kVrpnHeaderLength bytes.
VrpnStart readVrpnStart(std::string_view bytes) noexcept;

// Functions that encode and decode payloads. A returned text is a view of the payload. Decoding
// returns nothing if the payload is malformed.
std::string vrpnName(std::string_view name);  // for a description of a sender or type
std::optional<std::string_view> readVrpnName(std::string_view payload) noexcept;

// Pos_Quat: a sensor's pose. The decoded numbers are unchecked and can be NaN or infinite.
struct VrpnPose {
  std::int32_t sensor = 0;
  std::array<double, 3> position{};  // in the server's unit; VRPN asks for metres
  std::array<double, 4> orientation_wxyz{};
};
std::string vrpnPose(std::int32_t sensor, std::span<const float> position_m,
                     std::span<const float> orientation_wxyz);
std::optional<VrpnPose> readVrpnPose(std::string_view payload) noexcept;

// Button Change. A button that the server treats as a toggle is down while the toggle is on.
struct VrpnButton {
  std::size_t button = 0;  // less than kVrpnButtons
  bool down = false;
};
std::string vrpnButton(std::int32_t button, bool down);
std::optional<VrpnButton> readVrpnButton(std::string_view payload) noexcept;

// Button States. `down`: bit i is button i. vrpnButtons() REQUIRES: count <= 32.
struct VrpnButtons {
  std::size_t count = 0;  // at most kVrpnButtons
  std::bitset<kVrpnButtons> down;
};
std::string vrpnButtons(std::uint32_t down, std::int32_t count);
std::optional<VrpnButtons> readVrpnButtons(std::string_view payload) noexcept;

// Analog Channel: the values of all channels of a device, in the server's unit; decoded values are
// finite.
struct VrpnChannels {
  std::size_t count = 0;  // at most kVrpnChannels
  std::array<double, kVrpnChannels> value{};
};
std::string vrpnChannels(std::span<const double> channels);
std::optional<VrpnChannels> readVrpnChannels(std::string_view payload) noexcept;

}  // namespace merlin
