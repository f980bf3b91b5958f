// Settings: everything that a configuration file says, with the values that hold where it is
// silent.
#pragma once

#include <string>
#include <vector>

#include "daemon/serve/settings.h"
#include "drivers/cyberglove/settings.h"
#include "drivers/fastrak/settings.h"
#include "drivers/gpio/settings.h"
#include "drivers/hand/settings.h"
#include "drivers/spaceball/settings.h"
#include "nn/settings.h"
#include "render/frame/settings.h"
#include "render/governor/settings.h"
#include "render/out/settings.h"
#include "render/scene/settings.h"
#include "render/tiles/settings.h"

namespace merlin {

// Which device it is, where, and how fast its line runs.
struct LineSettings {
  std::string driver;  // a name of drivers/registry
  std::string port;  // "serial:/dev/...", "pty:PATH", "tcp://HOST:PORT", "replay:FILE"; empty: none
  int baud = 38400;
  int max_bytes_s = 0;  // that are read; 0: four times what the baud carry, of tcp:// a million
};

struct DevicesSettings {
  LineSettings glove_line{"cyberglove", "", 38400};
  CybergloveSettings glove;
  LineSettings tracker_line{"fastrak", "", 38400};
  FastrakSettings tracker;
  LineSettings ball_line{"spaceball", "", 9600};
  SpaceballSettings ball;
  HandSettings hand;
  GpioSettings gpio;
  std::string postures;  // the posture network's file; empty: none is recognised
  nn::HoldSettings posture_hold;
  // Within which idle cores wake, for the whole machine; -1: as the system has it.
  int cpu_latency_us = -1;
  std::string script = "visit";  // what the emulated person does, with --emulate
};

// Where the wall's input comes from, if not from this machine's devices.
struct InputSettings {
  std::string
      endpoint;  // "tcp://HOST:PORT" of another merlind; empty: this machine's shared memory
  std::string server_key;  // that merlind's public key
  std::string keys;        // this machine's pair of keys, a file
};

struct ContentSettings {
  std::string model;  // an .mrm file
};

struct WallSettings {
  InputSettings input;
  std::string model;                      // an .mrm file, shown first
  std::vector<ContentSettings> contents;  // shown after it, in turn
  render::GovernorSettings governor;
  render::TilesSettings tiles;
  render::SceneSettings scene;
  render::RenderSettings render;
  std::vector<render::OutputSettings> outputs = {{}};
  std::string snapshots;  // where the action snapshot puts its files, a folder; empty: nowhere
  int snapshots_kept = 1000;
};

struct Settings {
  // Keeps two daemons on one machine apart: names of shared memory and sockets.
  std::string instance = "merlin";
  // Where sockets and emulators' lines lie; empty: /run/merlin for root, else the user's own.
  std::string run_directory;
  DevicesSettings devices;
  WallSettings wall;
  ServeSettings serve;
};

}  // namespace merlin
