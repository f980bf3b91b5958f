// Settings: everything that a configuration file can set, with default values.
#pragma once

#include <string>
#include <vector>

#include "daemon/actions/settings.h"
#include "daemon/alarms/settings.h"
#include "daemon/page/settings.h"
#include "daemon/serve/settings.h"
#include "daemon/wall/settings.h"
#include "drivers/gpio/settings.h"
#include "drivers/hand/settings.h"
#include "drivers/pjlink/settings.h"
#include "drivers/port/port_address.h"
#include "drivers/registry.h"
#include "nn/settings.h"
#include "render/frame/settings.h"
#include "render/governor/settings.h"
#include "render/out/settings.h"
#include "render/room/settings.h"
#include "render/scene/settings.h"
#include "render/stereo/settings.h"
#include "render/text/settings.h"
#include "render/tiles/settings.h"

namespace merlin {

// A device that is read: its port, its driver and the settings of the driver.
struct DeviceSettings {
  std::string name;  // unique; used for its slots in shared memory, in the status and in bindings
  // The person who uses the device; all devices of one person may act on the wall together.
  std::string person;
  LineSettings line;
  DriverSettings own;  // settings of all drivers; only those of line.driver are used
};

// Returns the devices of a configuration without /devices: "glove", "tracker" and "ball", with the
// drivers cyberglove, fastrak and spaceball and without ports.
std::vector<DeviceSettings> defaultDevices();

struct DevicesSettings {
  std::vector<DeviceSettings> list = defaultDevices();
  std::vector<HandSettings> hands = {{}};
  GpioSettings gpio;
  std::vector<PjlinkSettings> projectors;
  // Also for the projectors that gpio.projector_line switches.
  std::vector<SwitchingTimes> projector_schedule;
  std::string postures;  // file of the posture network; empty: no posture is recognised
  nn::HoldSettings posture_hold;
  bool posture_drift = true;  // whether slow drift of the glove's sensors is followed
  std::string gestures;       // file of trained gestures; empty: no gesture is recognised
  std::vector<Binding> bindings = defaultBindings();
  // Time [s] after which the buttons and postures of a device that has stopped working count as
  // released.
  double stale_after_s = 0.5;
  // With several people: while one person acts on the wall, and for this time [s] afterwards, the
  // input of other people does not move what is shown.
  double turn_s = 3;
  // Maximum wake-up latency of idle CPU cores, for the whole machine [us]; -1: unchanged from the
  // system's setting.
  int cpu_latency_us = -1;
  std::string script = "visit";  // what the emulated person does, with --emulate
};

// The end of messages about a configuration without projectors, after "needs" or "has no".
inline constexpr const char* kProjectorsNeeded =
    "projectors: /projectors is empty, and /gpio has no chip with a projector_line";

// Another machine whose devices the wall uses instead of this machine's.
struct InputSettings {
  std::string endpoint;    // "tcp://HOST:PORT" of another merlind; empty: use this machine's
  std::string server_key;  // public key of that merlind
  std::string keys;        // file with this machine's key pair
};

// A content of the wall. Exactly one of `model`, `picture` and `slides` is set.
struct ContentSettings {
  std::string name;     // empty: the name of the file without its ending
  std::string model;    // an .mrm file
  std::string picture;  // a pyramid, as `merlin image import` makes it
  std::string slides;   // a folder of pyramids
  render::content::ShowAs show_as = render::content::ShowAs::kAsMarked;
};

struct WallSettings {
  InputSettings input;
  // An .mrm file, shown first. Empty: contents[0] is shown first.
  std::string model;
  std::vector<ContentSettings> contents;  // further contents, shown in turn by next_content
  PlaylistSettings playlist;
  ShownSettings shown;
  render::governor::GovernorSettings governor;
  render::room::RoomSettings room;     // alternative to `tiles`
  render::tiles::TilesSettings tiles;  // computed by loadSettings() if a room is given
  render::stereo::StereoSettings stereo;
  render::scene::SceneSettings scene;
  render::frame::RenderSettings render;
  render::text::OperatorSettings operator_tile;
  std::vector<render::out::OutputSettings> outputs = {{}};
  std::string snapshots;  // folder for the frames that the action snapshot writes; empty: off
  int snapshots_kept = 1000;
};

struct Settings {
  // Name of the daemon. It is part of the names of shared memory and sockets, and so distinguishes
  // several daemons on one machine.
  std::string instance = "merlin";
  // Folder for sockets and the emulators' pseudo-terminals. Empty: the folder that systemd sets,
  // otherwise /run/merlin for root, and $XDG_RUNTIME_DIR/merlin or /tmp/merlin-UID for other users.
  std::string run_directory;
  // File in which merlind keeps what people change at run time, such as the alignment. Empty:
  // INSTANCE.state.json in the state folder of systemd or, without one, of the user.
  std::string state_file;
  DevicesSettings devices;
  WallSettings wall;
  ServeSettings serve;
  PageSettings page;
  std::vector<AlarmSettings> alarms;
};

}  // namespace merlin
