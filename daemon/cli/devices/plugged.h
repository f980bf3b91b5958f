// Finds what is plugged into this machine and could serve as a device: serial adapters, input
// devices of the kernel, the socket of spacenavd.
#pragma once

#include <string>
#include <vector>

namespace merlin::cli {

struct Plugged {
  // One way to serve, as an entry of the configuration's list "devices".
  struct Use {
    std::string name;    // for the device
    std::string driver;  // driver that reads it
  };

  std::string kind;       // "serial adapter", "gamepad", "space mouse" ..., for a person
  std::string name;       // as the device says, for a person
  std::string port;       // in a form that parsePort() understands
  std::string path;       // path of its file, with links resolved
  std::vector<Use> uses;  // at least one; for an adapter, one for each kind of device
  bool readable = false;  // whether the calling process may read it
  std::string group;      // group of its file, whose members may read it; empty: unknown
  // For an input device that the driver evdev reads: its axes and keys, by the names that the
  // driver's settings use, and a text about those that are read if the settings name none: "axes x,
  // ...; buttons south, ...".
  std::vector<std::string> axes, keys;
  std::string usual;
};

// Reads /dev, /sys and /run below `root` (tests give one of their own; no "/" at its end); opens no
// device. The result has a fixed order: adapters, input devices, sockets, each by name. Devices
// that cannot be read are listed too. Cost: a few files for each input device.
std::vector<Plugged> findPlugged(const std::string& root = "");

// The wanted name, or, if it is taken, the first free one of "mouse_2", "mouse_3" ...
std::string freeName(const std::string& wanted, const std::vector<std::string>& taken);

// Changes the names of uses ("mouse_2") so that they differ from those in `taken`, and so that
// those of devices with only one use differ from each other.
void nameApart(std::vector<Plugged>& all, std::vector<std::string> taken);

// The entry for the list "devices" of the configuration.
std::string configurationEntry(const Plugged& plugged, const Plugged::Use& use);

}  // namespace merlin::cli
