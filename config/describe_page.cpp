#include "config/describe_page.h"

#include <string>

#include <fmt/format.h>

#include "daemon/base/event_kinds.h"

namespace merlin {

void describePage(PageSettings& p, SettingsVisitor& v) {
  v.flag("enabled", p.enabled,
         "Whether the operator's page is served. If it is not, only /metrics is served.");
  v.flag("metrics", p.metrics,
         "Whether the measurements of both roles are served at /metrics, as text for Prometheus.");
  v.text("address", p.address,
         "IPv4 address at which the page listens. 127.0.0.1: only browsers on this machine reach "
         "it. With any address that other machines reach, such as 0.0.0.0, reading needs the "
         "page's token, as commands always do; the connection is not encrypted.");
  v.integer("port", p.port, {1, 65535}, "TCP port at which the page listens.");
  v.text("host_names", p.host_names,
         "Names under which browsers reach the page, separated by spaces, such as "
         "wall.lab.example; requests for other names are refused. Addresses and localhost are "
         "always accepted.");
  v.number("picture_hz", p.picture_hz, {0.2, 30},
           "Maximum number of pictures of the wall per second that are sent to a browser.");
}

void describeAlarm(AlarmSettings& a, SettingsVisitor& v) {
  v.texts(
      "run", a.run,
      "Program to be started, as an absolute path, and its arguments. The event is its standard "
      "input, one line of JSON with instance, role, time_utc, kind, what and left_out, which is "
      "the number of events since the program's last start for which it was not started.");
  static const std::string kKinds = [] {
    std::string text = "Kinds of the events for which the program is started; empty: all kinds.";
    for (const EventKind& kind : kEventKinds) text += fmt::format(" {}: {}.", kind.name, kind.help);
    return text;
  }();
  v.texts("kinds", a.kinds, kKinds.c_str());
  v.integer("most_per_hour", a.most_per_hour, {1, 3600},
            "Maximum number of times per hour that the program is started.");
  v.number("time_limit_s", a.time_limit_s, {0.1, 3600},
           "Time in seconds after which the program and all that it started are ended.");
}

}  // namespace merlin
