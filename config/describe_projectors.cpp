#include "config/describe_projectors.h"

namespace merlin {

void describeProjectors(DevicesSettings& d, SettingsVisitor& v) {
  v.listOf<PjlinkSettings>(
      "projectors", d.projectors,
      "Projectors that are switched over the network by PJLink. The commands projector_on and "
      "projector_off switch them together with those at /gpio/projector_line.",
      [&](PjlinkSettings& p) {
        v.text("name", p.name, "Name of the projector: 1 to 32 letters, digits, - and _.");
        v.text("address", p.address,
               "Network address of the projector: HOST or HOST:PORT; without PORT it is 4352.");
        v.secretFile(
            "password_file", p.password_file,
            "File whose first line is the password for PJLink, readable by merlind. Empty: the "
            "projector asks for no password.");
        v.text("input", p.input,
               "Input that is selected each time the projector has been switched on, as two "
               "digits: 1 (RGB), 2 (video), 3 (digital), 4 (storage) or 5 (network), then the "
               "number of the input from 1 to 9. Empty: the input stays.");
        v.number("warm_up_s", p.warm_up_s, {1, 3600},
                 "Maximum time, in seconds, that the projector may take to report that it is on. "
                 "If it takes longer, its health becomes failed.");
        v.number("cool_down_s", p.cool_down_s, {1, 3600},
                 "Maximum time, in seconds, that the projector may take to report that it is off. "
                 "If it takes longer, its health becomes failed.");
      });
  v.listOf<SwitchingTimes>(
      "projector_schedule", d.projector_schedule,
      "Times at which all projectors are switched on and off, also those at "
      "/gpio/projector_line. Outside of all entries they are off. A person's command holds "
      "until the next time of the schedule. Empty: there is no schedule.",
      [&](SwitchingTimes& t) {
        v.texts("days", t.days,
                "Days on which the projectors are switched on: mon, tue, wed, thu, fri, sat, sun.");
        v.text("on", t.on, "Local time at which the projectors are switched on: HH:MM.");
        v.text("off", t.off,
               "Local time at which the projectors are switched off: HH:MM. If this is earlier "
               "than the time of `on`, it is a time of the following day.");
      });
}

}  // namespace merlin
