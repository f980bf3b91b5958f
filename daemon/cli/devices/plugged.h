// What is plugged into this machine and could serve as a device: serial adapters, input devices of
// the kernel, the socket of spacenavd.
#pragma once

#include <string>
#include <vector>

namespace merlin::cli {

struct Plugged {
  std::string kind;  // "serial adapter", "gamepad", "space mouse" ..., for a person
  std::string name;  // as the device says, for a person
  std::string port;  // in a form that parsePort() understands
  std::string path;  // of its file, without links
  // The keys of /devices for which it may serve: of an adapter "glove", "tracker" and "ball".
  std::vector<std::string> roles;
  std::string driver;     // that reads it; empty: the usual one of each role
  bool readable = false;  // by the calling process
  std::string group;      // of its file, whose members may read it; empty: unknown
};

// Reads /dev, /sys and /run below `root` (tests give one of their own; no "/" at its end); opens no
// device. In a fixed order: adapters, input devices, sockets, each by name. Devices that cannot be
// read are listed too. Cost: a few files for each input device.
std::vector<Plugged> findPlugged(const std::string& root = "");

// The line of the configuration that makes it the device `role`.
std::string configurationLine(const Plugged& plugged, const std::string& role);

}  // namespace merlin::cli
