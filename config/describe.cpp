// describe(): presents every setting with its key, range and meaning. The loader, the schema, the
// manual page and `merlind --print-config` all use this only description.
#include "config/describe_devices.h"
#include "config/describe_page.h"
#include "config/describe_wall.h"
#include "config/settings.h"
#include "config/visitor.h"

namespace merlin {
namespace {

void describeServe(ServeSettings& s, SettingsVisitor& v) {
  v.path("spnav_socket", s.spnav_socket,
         "Unix socket from which programs that use libspnav receive the Spaceball's data, usually "
         "/run/spnav.sock. Empty: no such server.");
  v.integer("vrpn_port", s.vrpn_port, {0, 65535},
            "Port from which VRPN clients on this machine receive the data of hand, tracker and "
            "ball, usually 3883; 0: no such server.");
  v.text("samples_endpoint", s.samples_endpoint,
         "Address from which walls on other machines receive the devices' samples, encrypted, such "
         "as tcp://*:7401. Empty: no such server.");
  v.secretFile("samples_keys", s.samples_keys,
               "File with this machine's key pair, written by `merlin keys -o FILE`.");
  v.path("samples_clients", s.samples_clients,
         "File with the public keys of the machines that may receive samples, one per line.");
  v.text("wall_endpoint", s.wall_endpoint,
         "Address at which the wall answers status and commands of other machines, encrypted, such "
         "as tcp://*:7402. Empty: other machines get no answer.");
  v.text("devices_endpoint", s.devices_endpoint,
         "Address at which the devices' side answers status and commands of other machines, "
         "encrypted, such as tcp://*:7403; its port is not that of wall_endpoint. Empty: other "
         "machines get no answer.");
  v.text("wall_topics_endpoint", s.wall_topics_endpoint,
         "Address at which other machines follow the wall's topics (status, metrics, event), "
         "encrypted, such as tcp://*:7404. Empty: they cannot. The devices' topics are at "
         "samples_endpoint.");
  v.secretFile("commands_keys", s.commands_keys,
               "File with this machine's key pair for wall_endpoint, devices_endpoint and "
               "wall_topics_endpoint, written by `merlin keys -o FILE`.");
  v.path("commands_clients", s.commands_clients,
         "File with the public keys of those who may send commands to wall_endpoint and "
         "devices_endpoint, one per line.");
  v.path("commands_readers", s.commands_readers,
         "File with the public keys of those who may read status, events and topics at "
         "wall_endpoint, devices_endpoint and wall_topics_endpoint, but send no other command, "
         "one per line.");
}

}  // namespace

void describe(Settings& s, SettingsVisitor& v) {
  v.text("instance", s.instance,
         "Name of this daemon. It is part of the names of shared memory and sockets and so "
         "distinguishes several daemons on one machine.");
  v.path(
      "run_directory", s.run_directory,
      "Folder for sockets and for the emulators' pseudo-terminals. Empty: the folder that "
      "systemd sets, otherwise /run/merlin for root, and for other users $XDG_RUNTIME_DIR/merlin "
      "or /tmp/merlin-UID.");
  v.path("state_file", s.state_file,
         "File in which merlind keeps what people change while it runs (the alignment of outputs, "
         "the frame rate, the content that is shown, that the playlist or the projectors were "
         "switched off), so that it is there after a restart. Empty: "
         "INSTANCE.state.json in the folder that systemd sets, otherwise in /var/lib/merlin for "
         "root, and for other users in $XDG_STATE_HOME/merlin or ~/.local/state/merlin.");
  describeDevices(s.devices, v);
  v.group("wall", "What the wall shows, how it is drawn, and which outputs receive the frames.",
          [&] { describeWall(s.wall, v); });
  v.group("serve", "Servers for other programs and machines.", [&] { describeServe(s.serve, v); });
  v.group("page", "The web page of the operator, which `merlind --role page` serves.",
          [&] { describePage(s.page, v); });
  v.listOf<AlarmSettings>("alarms", s.alarms,
                          "Programs that `merlind --role alarms` starts when something happens.",
                          [&](AlarmSettings& a) { describeAlarm(a, v); });
}

}  // namespace merlin
