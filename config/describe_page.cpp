#include "config/describe_page.h"

namespace merlin {

void describePage(PageSettings& p, SettingsVisitor& v) {
  v.flag("enabled", p.enabled, "Whether the operator's page is served. If not, only /metrics is.");
  v.flag("metrics", p.metrics,
         "Whether the measurements of both roles are served at /metrics, as text for Prometheus.");
  v.text("address", p.address,
         "IPv4 address at which the page listens. 127.0.0.1: browsers on this machine alone. With "
         "any address that other machines reach, such as 0.0.0.0, reading needs the token too; the "
         "connection is not encrypted.");
  v.integer("port", p.port, {1, 65535}, "TCP port at which the page listens.");
  v.text("host_names", p.host_names,
         "Names under which browsers reach the page, separated by spaces, such as "
         "wall.lab.example; requests for other names are refused. Addresses and localhost are "
         "always accepted.");
  v.number("picture_hz", p.picture_hz, {0.2, 30},
           "Pictures of the wall per second that a browser gets at most.");
}

}  // namespace merlin
