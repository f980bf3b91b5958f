// PortAddress: address of a device's line: `serial:/dev/...`, `pty:PATH` (an emulator or another
// program's pseudo-terminal), `tcp://HOST:PORT` (a raw serial server), `unix:PATH` (a local socket
// that another program listens at, such as spacenavd's), `evdev:PATH` (an input device of the
// kernel), `udp:PORT` or `udp://ADDRESS:PORT` (datagrams that other programs send to this port, at
// 127.0.0.1 or at that address of this machine) or `replay:FILE` (a transcript).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "daemon/base/setting_fault.h"

namespace merlin {

enum class PortKind { kSerial, kPty, kTcp, kUdp, kUnix, kEvdev, kReplay };

struct PortAddress {
  PortKind kind = PortKind::kPty;
  // Path of the device or file; for kTcp the host, for kUdp the address at which it is received,
  // 127.0.0.1 unless the port names another.
  std::string path;
  std::string service;  // for kTcp and kUdp only: the port's number

  // Returns whether MERLIN sets the baud rate of the line.
  bool hasSpeed() const noexcept { return kind == PortKind::kSerial || kind == PortKind::kPty; }
};

// Parses the address of a line. Errors: kInvalidArgument; the message lists the allowed forms.
Result<PortAddress> parsePort(std::string_view text);

// Returns whether both addresses denote the same line, in whatever notation, or receive the same
// datagrams, as 0.0.0.0 receives those of 127.0.0.1. serial: and pty: with the same path are one
// line; the caller has to resolve links first. Two transcripts are always two lines.
bool sameLine(const PortAddress& a, const PortAddress& b);

// Returns the speeds of serial lines that the drivers support, ascending [baud].
std::span<const int> lineSpeeds();

// Speed of a line whose driver has no default.
inline constexpr int kUsualBaud = 38400;

// Settings of one device's line.
struct LineSettings {
  std::string driver;  // a name from drivers/registry
  std::string port;    // in a form that parsePort() understands; empty: no device
  int baud = 0;        // 0: the driver's usual speed
  // Maximum number of bytes read per second; 0: four times what the baud rate carries, or a million
  // for a line that has none.
  int max_bytes_s = 0;
};

// Returns faults for a port or speed that is not allowed, and for a port that the driver cannot
// read. Their JSON pointers are "/port" and "/baud".
SettingFaults validate(const LineSettings& line);

}  // namespace merlin
