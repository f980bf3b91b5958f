// Finds what is plugged into this machine and could be read as a device: serial adapters, input
// devices of the kernel, and the socket of spacenavd.
#pragma once

#include <string>
#include <vector>

namespace merlin::cli {

struct Plugged {
  // One way to read the device, as an entry of the list "devices" of the configuration.
  struct Use {
    std::string name;    // name of the device
    std::string driver;  // driver that reads it
  };

  std::string kind;       // "serial adapter", "gamepad", "space mouse" ..., for a person
  std::string name;       // the name that the hardware states, for a person
  std::string port;       // in a form that parsePort() understands
  std::string path;       // path of its device file, with links resolved
  std::vector<Use> uses;  // at least one; a serial adapter has one for each kind of device
  bool readable = false;  // whether this process may open it
  std::string group;      // group of its device file, whose members may open it; empty: unknown
  // For an input device that the driver evdev can read: its axes and keys, by the names that the
  // driver's settings use. `usual`: a text about those that the driver reads if the settings name
  // none, "axes x, ...; buttons south, ...".
  std::vector<std::string> axes, keys;
  std::string usual;
};

// Looks for devices in /dev, /sys and /run below the folder `root` (for tests; without "/" at the
// end); opens no device. The result is sorted: adapters, input devices, sockets, each by name.
// Devices that this process may not open are listed too. Cost: reads a few files for each input
// device.
std::vector<Plugged> findPlugged(const std::string& root = "");

// Returns `wanted` if it is not in `taken`, otherwise the first free name of "WANTED_2", "WANTED_3"
// ...
std::string freeName(const std::string& wanted, const std::vector<std::string>& taken);

// Renames uses (to "mouse_2") so that no name is in `taken`, and so that no use has the same name
// as a device before it with only one use.
void nameApart(std::vector<Plugged>& all, std::vector<std::string> taken);

// Returns the JSON text of the entry for the list "devices" of the configuration.
std::string configurationEntry(const Plugged& plugged, const Plugged::Use& use);

}  // namespace merlin::cli
