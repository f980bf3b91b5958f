#include "config/describe_devices.h"

#include <fmt/format.h>

#include "config/describe_panel.h"
#include "config/describe_projectors.h"
#include "daemon/base/commands.h"
#include "drivers/registry.h"

namespace merlin {
namespace {

constexpr const char* kWhen[] = {"by_action", "enter", "hold", "leave"};
constexpr const char* kScripts[] = {"visit",     "turning", "still", "grabbing",
                                    "alignment", "panel",   "pushes"};

void describePerson(std::string& person, SettingsVisitor& v) {
  v.text("person", person,
         "Name of the person who uses the device or the hand, any text; it may be empty. Devices "
         "and hands with the same name belong to one person; while one person acts on the wall, "
         "the input of the others does not move what is shown (see /people/turn_s).");
}

// Describes the setting "driver"; its value is empty if the file names no driver.
void describeDriver(std::string& driver, SettingsVisitor& v) {
  static const std::vector<const char*> kNames = [] {
    std::vector<const char*> names;
    for (const DriverEntry& entry : drivers()) names.push_back(entry.name);
    return names;
  }();
  static const std::string kHelp = [] {
    std::string text = "Driver that speaks to the device, which must be given:";
    for (const DriverEntry& entry : drivers())
      text += fmt::format(" {} ({}: {});", entry.name, kindName(entry.kind), entry.help);
    text.back() = '.';
    return text;
  }();
  v.choiceOf("driver", driver, kNames, kHelp.c_str());
}

void describeLine(LineSettings& line, SettingsVisitor& v) {
  describeDriver(line.driver, v);
  v.text(
      "port", line.port,
      "Where the device is connected: serial:/dev/... (preferably a name under /dev/serial/by-id), "
      "pty:PATH, tcp://HOST:PORT (a raw serial server, or a VRPN server), udp:PORT (datagrams that "
      "come to this port from this machine, for TUIO and OSC) or "
      "udp://ADDRESS:PORT (also from others), unix:PATH (a socket, "
      "such as spacenavd's unix:/run/spnav.sock), evdev:/dev/input/... (an input device, "
      "preferably "
      "a name under /dev/input/by-id) or replay:FILE. Empty: no device. `merlin devices` lists "
      "what "
      "is plugged in.");
  static const std::string kBaud =
      fmt::format("Speed of the serial line in bits per second: {}. 0: the driver's usual speed.",
                  fmt::join(lineSpeeds(), ", "));
  v.integer("baud", line.baud, {0, static_cast<double>(lineSpeeds().back())}, kBaud.c_str());
  v.integer("max_bytes_s", line.max_bytes_s, {0, 100'000'000},
            "Maximum number of bytes per second that are read from the device. A device that sends "
            "more is read at this rate and without real-time priority, and its health says so. "
            "0: four times the number that the baud rate allows, or 1000000 for a port that is "
            "neither serial: nor pty:.");
}

// Describes the settings of all drivers; only those of the device's own driver are allowed. If the
// device has no driver, which is reported elsewhere, the settings of every driver are allowed.
void describeOwn(DeviceSettings& d, SettingsVisitor& v) {
  for (const DriverEntry& entry : drivers()) {
    if (!entry.describe) {
      v.excluded(entry.name, "has no settings: leave it out");
      continue;
    }
    v.groupIf(
        d.line.driver.empty() || d.line.driver == entry.name, entry.name,
        fmt::format("Settings of the driver {}; only for a device with this driver.", entry.name)
            .c_str(),
        [&] { entry.describe(d.own, v); },
        fmt::format("is for the driver {}, and this device's driver is {}: leave it out or change "
                    "the driver",
                    entry.name, d.line.driver)
            .c_str());
  }
}

void describeDevice(DeviceSettings& d, SettingsVisitor& v) {
  v.text("name", d.name,
         "Name of the device in shared memory, in the status and in bindings: 1 to 16 of a to z, 0 "
         "to 9 and _, beginning with a letter. Empty: the kind of the driver: glove, tracker, ball "
         "or touch.");
  describePerson(d.person, v);
  describeLine(d.line, v);
  describeOwn(d, v);
}

void describeHand(HandSettings& h, SettingsVisitor& v) {
  v.text("name", h.name,
         "Name of the hand in shared memory and in the status: 1 to 16 of a to z, 0 to 9 and _, "
         "beginning with a letter. No device may have the same name.");
  describePerson(h.person, v);
  v.text("glove", h.glove,
         "Name of the glove that the hand wears. Empty: the first glove. none: the hand wears no "
         "glove, for example because it holds a tracked wand.");
  v.text("tracker", h.tracker,
         "Name of the tracker whose receiver is on the hand. Empty: the first tracker.");
  v.text("buttons", h.buttons,
         "Name of the device whose buttons the hand holds, for example those of a tracked wand "
         "(driver vrpn_pad) or of a remote control (evdev): its inputs that are bound to grab, fly "
         "or point_at then act with this hand. Empty: none. A device that no hand holds acts with "
         "the first hand, unless another one holds such an action.");
  v.integer(
      "station", h.station, {1, 4},
      "Tracker station that is worn on the hand, 1 to 4; it moves the model while the action "
      "grab is held. A wall that uses the devices of another machine needs this setting in its "
      "own configuration.");
  v.number("cutoff_hz", h.cutoff_hz, {0, 100},
           "Cut-off frequency f, in Hz, of the low-pass filter for the hand's pose while the "
           "hand is at rest. The filter adds a delay of 1 / (2 pi f) seconds. 0: no filter.");
  v.number("cutoff_per_m_s", h.cutoff_per_m_s, {0, 1000},
           "Increase of the cut-off frequency of the filter for the hand's pose with the hand's "
           "speed, in Hz per metre per second.");
  v.flag("gestures", h.gestures,
         "Whether the hand's gestures in time (motions such as a swipe or a circle) are "
         "recognised. This needs the file of trained gestures, /gestures/file.");
}

void describePostures(DevicesSettings& d, SettingsVisitor& v) {
  v.path("file", d.postures,
         "File of the neural network that recognises postures, in JSON. Empty: no posture is "
         "recognised.");
  v.number("hold_s", d.posture_hold.hold_s, {0, 10},
           "Minimum time that a posture must be held before it counts as begun, in seconds.");
  v.number("leave_s", d.posture_hold.leave_s, {0, 10},
           "Minimum time that a posture must be absent before it counts as ended, in seconds.");
  v.number("margin", d.posture_hold.least_margin, {0, 1},
           "Minimum margin for a posture to be recognised, from 0 to 1: the margin says how sure "
           "the posture network is. Half of it suffices to keep the current posture.");
  v.flag("drift", d.posture_drift,
         "Whether merlind follows the slow drift of the glove's sensors. Whenever it is sure of a "
         "posture, it learns from it how far each sensor has drifted, at most 0.3 of the sensor's "
         "range, and subtracts this drift before it recognises postures. The learned drift is "
         "forgotten when the glove is connected again.");
}

void describeGestures(DevicesSettings& d, SettingsVisitor& v) {
  v.path("file", d.gestures,
         "File of trained gestures in time (motions such as a swipe or a circle), in JSON; `merlin "
         "gesture train` writes it. Empty: no gesture is recognised. /wall/scene/tracker_axes says "
         "which way is right, up and towards the person; a merlind that only reads devices needs "
         "that setting too.");
}

// Returns the description of the setting "action", which lists all bindable actions with their help
// texts.
std::string actionsHelp() {
  std::string held, once;
  for (const CommandInfo& c : kCommands) {
    if (c.bindable == Bindable::kNo) continue;
    std::string& list = c.bindable == Bindable::kHeld ? held : once;
    list += fmt::format("{}{}: {}", list.empty() ? "" : " ", c.name, c.help);
  }
  return fmt::format(
      "Action of the input, which must be given. Actions that last as long as the input is held: "
      "{} Actions that happen once: {}",
      held, once);
}

void describeBindings(DevicesSettings& d, SettingsVisitor& v) {
  static const std::string kInput = fmt::format("Name of the input: {}.", kInputForms);
  static const std::string kAction = actionsHelp();
  static const std::string kRepeat = fmt::format(
      "Time after which an action that happens once happens again while the input is held, in "
      "seconds: {} or more. 0: it happens only once.",
      kShortestRepeat_s);
  v.listOf<Binding>(
      "bindings", d.bindings,
      "Inputs (buttons, postures, gestures, switches) and the action of each. Every merlind that "
      "draws a wall executes the actions for walls, also on another machine; the merlind that has "
      "the control panel executes the actions for the panel.",
      [&](Binding& b) {
        v.text("input", b.input, kInput.c_str());
        v.choiceOf("action", b.action, kActions, kAction.c_str());
        v.oneOf("on", b.when, kWhen,
                "When the action happens: hold (as long as the button is pressed or the posture is "
                "held), enter (once, when that begins) or leave (once, when that ends). by_action: "
                "hold for actions that last, enter for the others.");
        v.text("with", b.with,
               "Another input of the same device, which has to be held at the same time (a chord). "
               "Empty: no other input is needed.");
        v.number("after_s", b.after_s, {0, 60},
                 "How long the input has to be held before it counts, in seconds (a long press). "
                 "Bind the short press of the same input with on: leave; it does not happen when "
                 "the long one did.");
        v.number("repeat_s", b.repeat_s, {0, kLongestRepeat_s}, kRepeat.c_str());
      });
}

void describePeople(DevicesSettings& d, SettingsVisitor& v) {
  v.number("stale_after_s", d.stale_after_s, {0.1, 10},
           "Time after which the buttons and postures of a device that has stopped working count "
           "as released, in seconds.");
  v.number("turn_s", d.turn_s, {0, 60},
           "Time, in seconds, for which a person keeps the wall after acting on it: until it has "
           "passed, the input of other people does not move what is shown.");
}

void describeMachine(DevicesSettings& d, SettingsVisitor& v) {
  v.integer("cpu_latency_us", d.cpu_latency_us, {-1, 10000},
            "Maximum time that idle CPU cores may take to wake up, for the whole machine, in "
            "microseconds. 0 keeps them from sleeping, which costs power; -1 leaves the system's "
            "setting.");
  v.choiceOf("script", d.script, kScripts,
             "What the emulated person does when merlind runs with --emulate. visit: turns the "
             "model, rests, grabs it, lets go; turning: always twists the ball; still: does "
             "nothing; grabbing: makes a fist and opens it in turn while the hand moves; "
             "alignment: makes the movements that `merlin calibrate tracker` asks for; pushes: "
             "pushes and twists the ball as `merlin calibrate ball` asks; panel: works the "
             "operator's panel with the ball.");
}

}  // namespace

void describeDevices(DevicesSettings& d, SettingsVisitor& v) {
  v.listOf<DeviceSettings>(
      "devices", d.list,
      "The devices that are read. Left out: a cyberglove named glove, a fastrak named tracker and "
      "a spaceball named ball, without ports.",
      [&](DeviceSettings& device) { describeDevice(device, v); });
  v.listOf<HandSettings>(
      "hands", d.hands,
      "The hands, each of which combines a glove and a tracker. Left out: one hand with the name "
      "hand.",
      [&](HandSettings& hand) { describeHand(hand, v); });
  v.group("postures", "Recognition of the gloves' postures.", [&] { describePostures(d, v); });
  v.group(
      "gestures",
      "Recognition of the hands' gestures in time (motions such as a swipe or a circle). A motion "
      "during which an input of the same person holds grab, fly or point_at is no gesture.",
      [&] { describeGestures(d, v); });
  describeBindings(d, v);
  v.group("people", "How the input of several devices and people is combined.",
          [&] { describePeople(d, v); });
  v.group("gpio", "The wall's control panel on a GPIO chip.", [&] { describePanel(d.gpio, v); });
  describeProjectors(d, v);
  describeMachine(d, v);
}

}  // namespace merlin
