// What is plugged into this machine and could serve as a device: serial adapters, input devices of
// the kernel, the socket of spacenavd.
#pragma once

#include <string>
#include <vector>

namespace merlin::cli {

struct Plugged {
  // One way to serve, as an entry of the configuration's list "devices".
  struct Use {
    std::string name;    // for the device
    std::string driver;  // that reads it
  };

  std::string kind;       // "serial adapter", "gamepad", "space mouse" ..., for a person
  std::string name;       // as the device says, for a person
  std::string port;       // in a form that parsePort() understands
  std::string path;       // of its file, without links
  std::vector<Use> uses;  // at least one; of an adapter one for each kind of device
  bool readable = false;  // by the calling process
  std::string group;      // of its file, whose members may read it; empty: unknown
  // Of an input device that the driver evdev reads: its axes and keys, by the names of that
  // driver's settings, and which of them are read if these name none: "axes x, ...; buttons south,
  // ...".
  std::vector<std::string> axes, keys;
  std::string usual;
};

// Reads /dev, /sys and /run below `root` (tests give one of their own; no "/" at its end); opens no
// device. In a fixed order: adapters, input devices, sockets, each by name. Devices that cannot be
// read are listed too. Cost: a few files for each input device.
std::vector<Plugged> findPlugged(const std::string& root = "");

// The name, or where it is taken the first free one of "mouse_2", "mouse_3" ...
std::string freeName(const std::string& wanted, const std::vector<std::string>& taken);

// Changes names of uses so that they differ from the names in `taken`, and those of things that
// have only one use from each other: "mouse_2".
void nameApart(std::vector<Plugged>& all, std::vector<std::string> taken);

// The entry for the list "devices" of the configuration.
std::string configurationEntry(const Plugged& plugged, const Plugged::Use& use);

}  // namespace merlin::cli
